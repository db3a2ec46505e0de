#pragma once
// The trainer's own solvers run on a rig's protocol: the rod (physics/implicit_rod) for suture-cantilever, the tissue (physics/linear_fem)
// for spatula-press. Rigs whose deformation is homogeneous or whose law is algebraic (blocks, capstan, calibration, events of a needle)
// have none: their closed form is the simulation. Test: full_solver_test.

#include "base/pose.h"
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

class FullSolver {
 public:
  virtual ~FullSolver() = default;
  virtual std::string name() const = 0;
  /// Outputs of a trial before the sensor; `fine`: on a mesh of half the size. False where it did not come to rest.
  virtual bool run(const Trial& t, const Setting& s, bool fine, Eigen::MatrixXd& out) const = 0;
};

/// Null where there is none, or where an effect acts that the solver does not have.
std::unique_ptr<FullSolver> make_full_solver(const RigModel& model, const std::vector<const Form*>& forms);

}  // namespace filum::reconcile
