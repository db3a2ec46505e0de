#pragma once
// The trainer's own solvers run on a rig's protocol: the rod (physics/implicit_rod) for suture-cantilever and, on a bar, suture-pull, the tissue
// (physics/linear_fem) for spatula-press and for what is not homogeneous in a block (physics/pore_flow), the wall (physics/tube_slice) for vessel-inflation, the needle's track (physics/track_rig) for
// needle-insertion. Elsewhere a block's deformation is homogeneous (its closed form is the simulation), the forceps' line is the calibration's own code
// (devices/bridge_line.h), and a tip that is held has no input to simulate. Tests: full_solver_test, full_tube_test, full_pull_test, full_needle_test.

#include <functional>

#include "base/pose.h"
#include "base/tet_mesh.h"
#include "physics/hyperelastic.h"
#include "physics/tissue_law.h"
#include "physics/wall_softening.h"
#include "reconcile/hereditary.h"
#include "reconcile/model.h"

namespace filum::reconcile {

/// A thread of length and bending stiffness 1 clamped level, hanging under gravity G = rho g A L^3/(E I), at rest.
struct HangingRod {
  double drop = 0.0, reach = 1.0;  // of the tip, over the length
  bool rests = false;
};
/// `rest`: natural curvature times the length, at equal distances from the clamp to the tip, positive towards gravity.
HangingRod hang_rod(double G, const std::vector<double>& rest, int edges);

/// Force per depth and Young's modulus [m] of a blade pressed flat, without slip, on the middle of a box of tissue held at its bottom: static
/// equilibrium of linear tetrahedra with averaged pressure on a quarter of the box, cells graded towards the blade.
/// `cells`: under half the blade, across its width; the rest follows.
double press_stiffness(const Vec3& box, double blade_length, double blade_width, double poissons_ratio, int cells);
/// The quarter box of press_stiffness and its nodes under the blade, at the bottom and on the two planes of symmetry.
struct PressedBox {
  TetMesh mesh;
  std::vector<char> blade, bottom, middle_x, middle_y, free;  // of each node; free: of the surface, not under the blade
};
PressedBox pressed_box(const Vec3& box, double blade_length, double blade_width, int cells);

/// Mean of dev(eps):dev(eps) over 3/2 at a depth of one height, weighted by the energy of shape: what a square of depth over height is in the tissue.
double local_strain_square(const PressedBox& box, double height, double poissons_ratio);
/// Along a press to strain `peak` and back, by the elements' own law; `reduced`: force of (strain, largest past one) in units of the linear force at strain one.
/// Empty where an equilibrium was not found. The law's values are those of depth over height.
PressTable press_table(const PressedBox& box, double height, double poissons_ratio, const TissueLaw& law, double local_square, double peak, const std::function<double(double, double)>& reduced);

/// A specimen between platens: width x depth x height [m], or a cylinder of this width where `round`.
struct Block {
  double width = 0.0, depth = 0.0, height = 0.0;
  bool round = false;
};
/// Relaxation of a block's force after a sudden compression between platens without friction, drained at its sides or (`ends`) through the platens, for a diffusivity of 1 m2/s
/// and a share of the stiffness that drains away: finite elements of Biot's theory (physics/pore_flow) on an eighth of it.
Kernel block_drainage(const Block& block, double poissons_ratio, double share, bool ends, int cells);
/// The same under a blade, drained at the free surface.
Kernel press_drainage(const Vec3& box, double blade_length, double blade_width, double poissons_ratio, double share, int cells);
/// Stiffness of a block over E A/h where Coulomb friction acts at both platens: equilibrium of an eighth of it under a growing compression, linear but for the
/// platens' nodes, which hold or slide outwards (so the force is in proportion to the compression). On the way back no friction is turned round. NaN where not found.
double platen_stiffening(const Block& block, double poissons_ratio, double friction, int cells);

/// A tube without load, [m].
struct TubeWall {
  double inner = 0.0, outer = 0.0;
};
/// Lame's motion of the outer face over the finite elements', incompressible, at vanishing pressure; `around`: elements of a turn. NaN if not found.
double tube_linear_factor(const TubeWall& wall, int around);
/// Axial force of the finite elements at a vanishing axial stretch over E (stretch - 1) A, incompressible. NaN if not found.
double tube_axial_factor(const TubeWall& wall, int around);
/// The pressure of a wall of this law and opening angle [rad] beyond that of rubber with its mu, less `reduced` [Pa] (C [m2], axial stretch), for motions
/// up to `most` [m2] at one axial stretch or three; with `reduced_axial` [N] the same of the reduced axial force. linear is NaN where an equilibrium was not found.
WallTable tube_table(const TubeWall& wall, const WallLaw& law, double opening, const std::vector<double>& stretches, double most,
                     const std::function<double(double, double)>& reduced, int around, const std::function<double(double, double)>& reduced_axial = {});

/// A linear incompressible wall whose elements each soften by their own past, less the reduced law of the whole wall (W0 over Young's modulus, energy
/// (C/(a b))^2/2), for motions up to `most` [m2]; empty where an equilibrium was not found.
WallTable::Softened tube_softening(const TubeWall& wall, WallSoftening law, double most, int around);

/// T2/T1 of a limp thread drawn over a round bar that it touches for `wrap` [rad]; NaN where the rod failed.
double drawn_ratio(double mu, double wrap, int edges_a_radian);

/// A needle's way into tissue and out again.
struct NeedlePath {
  struct Rupture {
    double depth = 0.0, force = 0.0;  // [m] of the layer's face, [N] at which it gives way
    double stiffness = 0.0;           // [N/m], of this layer under the point; 0: the tissue's
  };
  std::vector<double> depth;          // [m], of each sample, 0 at the surface
  double deepest = 1e-3;              // [m]
  double stiffness = 100.0;           // [N/m], of the tissue under the point
  double puncture = 5e-3;             // [N]
  double touch = 0.0;                 // [N/m], before the puncture; 0: stiffness
  double friction = 0.0;              // [N/m], for each length inside,
  double friction_from = 0.0;         // [m], deeper than this
  std::vector<Rupture> ruptures;      // further layers, from the surface down
};
/// Force [N] along the needle at each sample, steps of at most `move` [m] of a path scaled to 0.6 mm.
std::vector<double> needle_forces(const NeedlePath& path, double move);

class FullSolver {
 public:
  virtual ~FullSolver() = default;
  virtual std::string name() const = 0;
  /// False where the deformation stays homogeneous with these forms, so that the law is the simulation.
  virtual bool needed(const std::vector<const Form*>&) const { return true; }
  /// Outputs of a trial before the sensor; `fine`: on a mesh of half the size. False where it did not come to rest.
  virtual bool run(const Trial& t, const Setting& s, bool fine, Eigen::MatrixXd& out) const = 0;
};

/// Null where there is none.
std::unique_ptr<FullSolver> make_full_solver(const RigModel& model);
std::unique_ptr<FullSolver> make_tube_solver(const RigModel& model);
std::unique_ptr<FullSolver> make_tissue_solver(const RigModel& model);
std::unique_ptr<FullSolver> make_needle_solver(const RigModel& model);
std::unique_ptr<FullSolver> make_pull_solver(const RigModel& model);

}  // namespace filum::reconcile
