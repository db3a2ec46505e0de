#pragma once
// Drainage: soft tissue as a porous elastic solid full of fluid, Biot, J. Appl. Phys. 12:155 (1941), grains and fluid incompressible:
//   sigma = lambda_d tr(eps) I + 2 G eps - p I,   p = Q (zeta - tr eps),   d zeta/dt = div(k grad p)
// zeta: fluid gained per volume [-], p: pore pressure [Pa], k: permeability over viscosity [m2/(Pa s)]. A sudden load moves no fluid: then the
// tissue has the bulk modulus K_u = K_d + Q, G is the same, so that the law is given by the modulus and Poisson's ratio of a sudden load, as every scene
// and rig states them, and Poisson's ratio once drained. Diffusivity D = k M Q/(M + Q), M = K_d + 4/3 G: what Terzaghi calls consolidation.
// On a mesh: tr eps averaged over the elements about each node (as linear_fem's averaged pressure, Bonet & Burton 1998), so pressures live on nodes and
// no pair of them can lock the displacement; flow by linear elements. Seen with the fluid's content for variable, the stiffness of a step is that of the sudden load and
// Q zeta is a load: stable for any Q, as long as zeta diffuses less than a cell in a step (PoreFlow takes as many shorter steps as that needs).
// Valid: small strains, constant permeability. Test: pore_flow_test (confined and unconfined compression in closed form).

#include <Eigen/Core>
#include <span>
#include <vector>

#include "physics/linear_fem.h"

namespace filum {

struct Drainage {
  double diffusivity = 0.0;      // D [m2/s]; 0: nothing drains
  double poisson_drained = 0.0;  // [-], below that of a sudden load
};
/// Poisson's ratio once drained where sudden uniaxial stiffness falls by this share (E_d/E_u = (1 + nu_d)/(1 + nu_u), since G stays).
double poisson_by_block(double share, double poisson);
/// The same under a flat punch on a half space (stiffness as G/(1 - nu)); at least -0.9.
double poisson_by_punch(double share, double poisson);

struct PoreLaw {
  double Q = 0.0, k = 0.0;   // [Pa], [m2/(Pa s)]
  FemMaterial drained;
};
/// Throws InputError unless -1 < poisson_drained < poisson and D > 0.
PoreLaw pore_law(const FemMaterial& sudden, const Drainage& d, const std::string& file);

/// Volume change averaged about the nodes and flow between them, on the elements that are there.
class PoreMesh {
 public:
  /// `k`: of each element [m2/(Pa s)].
  PoreMesh(const TetMesh& mesh, const std::vector<double>& k);
  int n() const noexcept { return static_cast<int>(volume_.size()); }
  double volume(int a) const noexcept { return volume_[a]; }             // [m3]
  double growth(int a, const Eigen::Ref<const Points>& u) const noexcept;  // [m3], V_a theta_a
  /// loads += sum_a p_a d(V_a theta_a)/du. [N]
  void push(const Eigen::VectorXd& p, Points& loads) const noexcept;
  double outflow(int a, const Eigen::VectorXd& p) const noexcept;        // [m3/s], from node a
  double conductance(int a, std::size_t i) const noexcept { return flow_[i + static_cast<std::size_t>(begin_[static_cast<std::size_t>(a)])]; }
  double own_conductance(int a) const noexcept;                          // [m3/(Pa s)]
  std::span<const int> near(int a) const noexcept;

 private:
  std::vector<int> begin_, node_;
  std::vector<Vec3> gradient_;   // [m2]
  std::vector<double> flow_;     // [m3/(Pa s)]
  Eigen::VectorXd volume_;
};

/// Drainage in a scene: the content of each node goes on by explicit steps.
class PoreFlow {
 public:
  PoreFlow(const TetMesh& mesh, const std::vector<FemMaterial>& regions, const Drainage& d, const std::string& file);
  int n() const noexcept { return mesh_.n(); }
  /// Content after dt [s] of flow at displacements u (3 x n), and its push on the nodes, which is added to loads [N]. `open`: nodes at which fluid leaves
  /// freely (p = 0). Allocates nothing.
  void step(const Eigen::Ref<const Points>& u, const std::vector<char>& open, double dt, Eigen::VectorXd& content, Points& loads) noexcept;
  double pressure(int a, const Eigen::Ref<const Points>& u, const Eigen::VectorXd& content) const noexcept;  // [Pa]

 private:
  PoreMesh mesh_;
  Eigen::VectorXd Q_, theta_, p_;
  double longest_ = 0.0;  // [s], of a stable step
};

/// Force that a unit of motion given at once leaves after t: rest + sum weight exp(-t/time).
struct DrainingForce {
  double rest = 0.0;                  // [N/m], drained
  std::vector<double> weight, time;   // [N/m], [s]
  double sudden() const;              // [N/m]
};

/// A body moved in proportion to one number, [m].
struct DrainingBody {
  TetMesh mesh;
  FemMaterial tissue;            // of a sudden load
  Drainage drainage;
  std::vector<char> held;        // of each coordinate, 3 n
  Points motion;                 // of the held coordinates for a unit of the number, 3 x n
  std::vector<char> open;        // of each node
};
/// The response by Krylov's method: Lanczos on the compliance of flow in the inner product of storage, begun with the pressure of a sudden motion; exact
/// at once and, moment by moment, at late times. The force is reckoned on what is held.
DrainingForce draining_force(const DrainingBody& body, int terms = 40);

}  // namespace filum
