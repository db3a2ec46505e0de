#pragma once
// One implicit time step of the thread with everything that touches it: backward Euler solved by Newton's method.
//
// The step is the minimiser of   1/2 |q - q^|^2_M / dt^2 + U_elastic + U_gravity + U_drag + U_contact + U_grasp,
// q^ = q_n + dt v_n (Martin et al., ACM TOG 30(4):72, 2011, eq. 4), with the normal forces of friction taken
// from its start (FrictionLoad). Each iterate is reached by a line search on that sum, and by no more than
// the fraction of the move that provably crosses nothing, so every accepted shape has the topology of the one before.
// Internal friction (Kelvin-Voigt) in backward Euler form, EI (|kappa - kappa0|^2 + r |kappa - kappa_n|^2)/2 with r = time/dt, is a
// stiffness (1 + r) EI about the rest shape (kappa0 + r kappa_n)/(1 + r), and is computed as that.
// Linear systems: base/block_cholesky.h. Cost is linear in nodes and contacts. Nothing allocates after the constructor.
// Tests: implicit_rod_test; `filum validate`.

#include <vector>

#include "physics/elastic_rod.h"
#include "physics/rod_contact.h"
#include "physics/rod_lengths.h"
#include "physics/rod_obstacle.h"
#include "physics/rod_tether.h"
#include "physics/thread_grasp.h"

namespace filum {

struct RodStepOptions {
  double dt = 1e-3;                   // [s]
  Vec3 gravity = Vec3(0, 0, -9.81);   // [m/s2]
  int max_iterations = 20;            // Newton iterations
  double force_tolerance = 1e-10;     // [N], unbalanced nodal force that is always good enough
  double longest_move = 1e3;          // [m], of a node in one iteration; a longer one shows a nearly singular stiffness
  double relative_tolerance = 1e-3;   // [-], of the largest tension or contact force in the thread
  int strict_iterations = 1000;       // from this iteration on the tolerance grows (late_tolerance)
};

/// [N], unbalanced force that ends a step after so many iterations; `scale` [N] is the largest tension or contact force. Late ones buy little: the thread slips from
/// touch to touch, and the next step goes on from there. So each grants 1.6 times more, up to 30 times and 0.1 mN, and 3 uN in any case (4 mm of 10-0 in a loop bend with 12 uN).
double late_tolerance(const RodStepOptions& o, int iterations, double scale) noexcept;

struct RodStepSummary {
  int iterations = 0;
  double residual = 0.0;              // [N], largest unbalanced nodal force
  bool converged = false;
  bool arrived = true;                // bodies and prescribed nodes reached the end of their path
  bool sound = true;                  // false: a number was not finite; the state is the one before the step
  bool crowded = false;               // more pairs of edges were near than there is room for: some were left out of contact
};

/// Nodes held or loaded from outside (validation problems and clamped ends); sizes 4 x capacity, rows x, y, z, theta.
struct RodBoundary {
  explicit RodBoundary(int capacity);
  Eigen::Matrix4Xd load;                                   // [N] and, for the twist of edge j, [N m]
  Eigen::Array<bool, 4, Eigen::Dynamic> held;              // true: follows `target`
  Eigen::Matrix4Xd target;                                 // [m], [rad], value at the end of the step where held
};

/// What the contact of a thread remembers from step to step. Part of the state.
struct RodMemory {
  std::vector<ContactBristle> self, obstacle;
  std::vector<GraspPoint> grasps;
};

class ImplicitRod {
 public:
  ImplicitRod(const RodMaterial& material, const ContactMaterial& contact, int node_capacity, int n_tools = 0);

  RodMaterial material;
  ContactMaterial contact_material;
  RodBoundary boundary;
  RodObstacles obstacles;
  ThreadGrasps grasps;
  RodTethers tethers;          // what soft bodies hold the thread by, filled before each step
  bool self_contact = true;

  /// Room for the bristles of one state.
  RodMemory make_memory() const;

  /// Advances state and memory by options.dt. Bodies and tools move from their X_start to X_end.
  RodStepSummary step(RodState& s, RodMemory& memory, const RodStepOptions& options) noexcept;

  /// The implicit midpoint rule (half a backward Euler step, then reflection): conserves momentum and nearly energy. Free of
  /// contact only: the reflection is not checked for crossings.
  RodStepSummary midpoint_step(RodState& s, RodMemory& memory, const RodStepOptions& options) noexcept;

  const RodContact& contact() const noexcept { return contact_; }

 private:
  void begin(const RodState& s, const RodMemory& memory, const RodStepOptions& o) noexcept;
  void expect_moves(const RodState& s, double dt) noexcept;
  void soften_rest(RodState& s, double dt) noexcept;
  void restore_rest(RodState& s) noexcept;
  void find_near(const RodState& s, const RodMemory& memory) noexcept;
  void fit_pattern(int n) noexcept;
  bool advance_boundary(const RodState& s) noexcept;
  void assemble_gradient(const RodState& s, const RodStepOptions& o) noexcept;
  void assemble_stiffness(const RodState& s, const RodStepOptions& o, Stiffness kind) noexcept;
  double force_scale(const RodState& s) const noexcept;
  bool direction(const RodState& s, const RodStepOptions& o, Stiffness& kind) noexcept;
  void adapt_inertia(bool shortened) noexcept;
  bool touches_nothing() const noexcept;
  void keep_lengths(const RodState& s, EdgeLength which) noexcept;
  bool newton_step(const RodState& s, const RodMemory& memory, const RodStepOptions& o) noexcept;
  void predict(const RodState& s, const RodMemory& memory, const RodStepOptions& o) noexcept;
  double free_fraction(const RodState& s, const RodMemory& memory) noexcept;
  bool try_move(const RodState& s, double fraction, double highest, const RodStepOptions& o) noexcept;
  bool advance(const RodState& s, const RodMemory& memory, const RodStepOptions& o) noexcept;
  void fit_geometry(const RodState& s) noexcept;
  double own_energy(const RodState& s, const Points& x, const Eigen::VectorXd& theta, const RodStepOptions& o) const noexcept;
  double touch_energy(double own, const RodState& s, const Points& x, const RodStepOptions& o, double fraction) noexcept;
  double energy_here(const RodState& s, const RodStepOptions& o) noexcept;
  void finish(RodState& s, RodMemory& memory, const RodStepOptions& o) noexcept;

  RodContact contact_;
  RodGeometry geometry_;
  BlockCholesky matrix_;
  ChainSlots chain_;
  int pattern_n_ = 0;
  Points x_, x_trial_;
  Eigen::VectorXd theta_, theta_trial_;
  Eigen::Matrix4Xd gradient_, move_, boundary_move_;
  RodLengths lengths_;
  Eigen::VectorXd inverse_mass_;           // [1/kg], of nodes; 0 where held
  RodMaterial stiffened_;                  // the material with what internal friction adds in this step
  Eigen::Matrix4Xd rest_kappa_;            // rest shape proper, while the step works with the softened one
  Eigen::VectorXd rest_twist_;
  double slope_ = 0.0;          // [J], of the sum along the Newton direction
  double extra_inertia_ = 0.0;  // [1], times the nodes' own, in the matrix only
  double last_energy_ = 0.0;    // [J], at the iterate before, with the loads of then
  bool geometry_fits_ = false;  // geometry_ is that of x_ and theta_
  bool own_known_ = false;      // own_ is own_energy() there
  double own_ = 0.0;            // [J]
};

}  // namespace filum
