#pragma once
// Soft tissue as a linear elastic continuum of four-node tetrahedra, dynamic, after
//   Hansen, Cotin, Brix et al., "Modelling of interaction between a spatula and a human brain", Med. Image Anal. 8:23 (2004).
//   M u'' + C u' + K u = f                                                    (1)   C = a M + b K (Rayleigh), M lumped
//   K_eff = 4/dt^2 M + 2/dt C + K                                             (2)   the paper prints -K: a misprint, see below
//   f_eff = f + M (4/dt^2 u + 4/dt u' + u'') + C (2/dt u + u')                (3)
//   K_eff u_1 = f_eff                                                         (4)
//   u'_1 = 2/dt (u_1 - u) - u',   u''_1 = 4/dt^2 (u_1 - u) - 4/dt u' - u''    (5, 6)
// Putting (5, 6) into (1) gives +K in (2); with -K the step is neither consistent nor stable. Solved for the increment
// u_1 - u, which is the same system with less cancellation: right side f + M ((4/dt + a) u' + u'') + K (b u' - u).
// Nodes that a rigid tool moves are given by MovedNode; the force that moves them is the haptic force (paper, section 4).
// They take u' = (u_1 - u)/dt and u'' = 0, in the measure that the tool decides: the trapezoidal rule would let the
// velocity of a prescribed node ring for ever. What only pushes leaves a node no faster than itself: the way out of a blade
// that a node has been found behind is no velocity, else it flies off, is caught behind the blade again, and so for ever.
// Symbols: E [Pa], nu [-], rho [kg/m3], a [1/s], b [s].  Valid: strains below about 10 %, rotations below about 10 degrees
// (a linear element that turns pushes back), nu < 0.5. Plain linear tetrahedra lock: nu = 0.45 bends 39 % too stiffly with
// 4 elements through the thickness; `averaged_pressure` takes the volume change averaged over the elements about each node
// (Bonet & Burton, Commun. Numer. Meth. Eng. 14:437, 1998), which cures it at five times the matrix.
// Relaxation at a fixed exposure: shares g_i of the stiffness are springs in series with dashpots, so that the elastic force is
// K (u - sum g_i w_i), w_i' = (u - w_i)/tau_i (a Prony series), which is exact for a linear solid held still: force =
// K u (1 - sum g_i (1 - exp(-t/tau_i))). w_i is advanced with the u of the last step: an error of dt/tau_i at most.
// Hongo et al. measured that the pressure halves in 6.6 minutes; w stays for a while, so a second retraction relaxes less.
// Elements can be taken out between steps; nothing is precomputed that this would spoil. Test: linear_fem_test.

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/tet_mesh.h"
#include "physics/linear_fem_solver.h"

namespace filum {

struct FemMaterial {
  double young = 3e3;      // [Pa]
  double poisson = 0.45;   // [-]
  double density = 1040.0; // [kg/m3]
};

/// Throws InputError where a value makes no solid: young <= 0, poisson outside (-1, 0.5), density <= 0, not finite.
void check_material(const FemMaterial& m, const std::string& file);

/// One term of the relaxation: this share of the stiffness goes with this time.
struct RelaxationTerm {
  double share = 0.0;    // g_i [-]
  double time = 360.0;   // tau_i [s]
};

struct FemOptions {
  double dt = 2e-3;                // [s]
  double mass_damping = 0.0;       // a [1/s]
  double stiffness_damping = 0.0;  // b [s]
  std::vector<RelaxationTerm> relaxation;  // empty: none; the shares sum to less than 1
  bool averaged_pressure = false;
  bool single_precision = false;   // of the matrix a step reads; sums stay in double
  FemSolverOptions solver;
};

struct FemState {
  Points u, v, a;               // [m], [m/s], [m/s2], 3 x n
  Points du;                    // [m], 3 x n, change of u in the last step: where the next one begins to look
  Points w;                     // [m], 3 x (n terms), relaxed displacements, term by term; 3 x 0 where nothing relaxes
  std::vector<char> removed;    // of each element
};

class LinearFem {
 public:
  /// Throws InputError for a bad mesh or material; `file` is named there.
  LinearFem(TetMesh mesh, std::vector<FemMaterial> regions, const FemOptions& options, const std::string& file = "mesh");
  ~LinearFem();
  LinearFem(const LinearFem&) = delete;

  /// These nodes never move from now on (bone, or the border of the region).
  void hold(std::span<const int> nodes);
  FemState rest() const;

  /// One step, Eq. 2-6. Loads are forces on nodes [N], 3 x n, or none. If a number is not finite the old displacement is
  /// kept, at rest, and summary.sound is false. Allocates nothing.
  FemSummary step(FemState& s, std::span<MovedNode> moved, const Points* loads = nullptr) noexcept;
  /// Rest under loads and moved nodes: K u = f. At least three nodes must be held or prescribed.
  FemSummary equilibrium(FemState& s, std::span<MovedNode> moved, const Points* loads = nullptr) noexcept;

  /// How the tissue answers movers at rest, from nothing but their targets: K x = 0 where nobody pulls, a few iterations on from
  /// the x given. What it costs the movers (their `force`) is the local stiffness that a hand feels between two steps.
  FemSummary respond(std::span<MovedNode> moved, Columns4& x) noexcept;
  /// Must have been called before respond(), and after hold().
  void prepare_response();

  /// Takes an element out of the tissue; its mass stays with its nodes. False if it is out already.
  bool remove_element(FemState& s, int e);
  /// Makes the matrices fit the elements a restored state has.
  void match(const FemState& s);

  double energy(const FemState& s) const;      // [J], kinetic and elastic
  Points elastic_force(const Points& u) const; // [N], K u
  Mat3 stress(const Eigen::Ref<const Points>& u, int e) const;   // [Pa], of the plain element
  Mat3 relaxed_stress(const FemState& s, int e) const;  // [Pa], of what has not relaxed
  double nodal_stiffness(int node) const noexcept;  // [N/m], a third of the trace of K_ii

  const TetMesh& mesh() const noexcept { return mesh_; }
  const FemOptions& options() const noexcept { return options_; }
  void set_solver(const FemSolverOptions& o) { options_.solver = o; }
  const BlockMatrix& stiffness() const noexcept { return K_; }
  const Eigen::VectorXd& mass() const noexcept { return mass_; }  // [kg], of each node
  const std::vector<char>& held() const noexcept { return held_; }

 private:
  struct Solvers;
  struct Gradients {
    Eigen::Matrix<double, 3, 4> b;  // [1/m], of the shape functions
    double volume = 0.0;            // [m3]
  };
  Gradients gradients(int e) const;
  void assemble(const std::vector<char>& removed);
  void add_element(int e, double sign);
  void add_averaged_pressure(const std::vector<char>& removed);
  void set_systems();
  FemSummary solve(FemState& s, std::span<MovedNode> moved, bool dynamic) noexcept;

  TetMesh mesh_;
  std::vector<FemMaterial> regions_;
  FemOptions options_;
  BlockMatrix K_;
  Eigen::VectorXd mass_;
  std::vector<char> held_, removed_;
  Columns4 right_, change_, work_;
  std::unique_ptr<Solvers> solvers_;
  bool responds_ = false;
};

}  // namespace filum
