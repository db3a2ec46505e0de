#pragma once
// A layered vessel wall (or card) that moves: backward Euler by quasi-Newton steps.
//
//   find x:  M ((1 + a h)(x - x_n) - h v_n) / h^2 = f_elastic(x) + f_pressure(x) + f_loads(x),   v = (x - x_n)/h
// solved with limited-memory BFGS whose first matrix is P = M (1 + a h)/h^2 + K at rest, factored once (Liu, Bouaziz & Kavan, ACM
// TOG 36:23, 2017; P turned node by node into the wall's present directions, so that a stump that is turned over or an
// edge that is everted meets a matrix of its own orientation, and stretched with them, so that what keeps its volume does so in P, too). Pairs are
// kept from step to step: a soft tube has bending modes that P does not know, and the next step meets them again (Morales & Nocedal, SIAM J. Optim.
// 10:1079, 2000). What they hold is the elements' part and that of edges that meet; springs are added as they touch and let go, within a step, too.
// Follower pressure on inner faces.
// Loads at material points are f + k (x_0 - x), x_0 where the point was when the load was given; what rubs or stands against the wall is part of the
// step's energy with the bounds of its force (wall_load.h): a wall this light goes all the way that a force kept for the step drives it, and
// comes back in the next.
// State is complete: same state, same loads, same next state. A step allocates nothing.
// Neglects: viscoelasticity (a damps against the surroundings only), fluid inertia. Tests: vessel_wall_test, vessel_wall_surface_test.

#include <algorithm>
#include <memory>
#include <span>
#include <vector>

#include "collision/surface_tree.h"
#include "physics/vessel_wall_element.h"
#include "physics/vessel_wall_matrix.h"
#include "physics/vessel_wall_pairs.h"
#include "physics/vessel_wall_springs.h"
#include "physics/wall_load.h"
#include "physics/wall_meeting.h"
#include "physics/wall_state.h"

namespace filum {

struct WallOptions {
  double dt = 2e-3;            // [s]
  double density = 1060.0;     // [kg/m3]
  double damping = 100.0;      // [1/s], against the surroundings
  double tolerance = 1e-5;     // [N], largest unbalanced force of a node
  int max_iterations = 24;
  int strict_iterations = 1000;  // from this iteration on the tolerance grows (late_tolerance)
  int memory = 20;             // pairs of the BFGS history, kept from step to step; at most 64
  bool single_precision = true;  // of the elements' forces
};

/// [N], after so many iterations. Late ones balance what the wall swings by as it snaps back from under an instrument; the next step goes on from there.
double late_tolerance(const WallOptions& options, int iterations) noexcept;

struct WallSummary {
  bool converged = false;      // within late_tolerance()
  bool sound = true;           // all numbers finite; a step that is not leaves the wall where it was, at rest
  int iterations = 0;
  double residual = 0.0;       // [N]
};

struct WallCrossing {
  bool found = false;
  WallPoint point;
  WallSurface surface = WallSurface::inner;
  double fraction = 1.0;       // along the segment
  Vec3 normal = Vec3::Zero();  // unit, outward from the tissue, of the face
  Vec3 away = Vec3::Zero();    // unit, of what is nearest: in which the distance grows outward; at a rim, a ridge or in a fold not the normal of either face
  int triangle = -1;           // of triangles()
  Vec3 weights = Vec3::Zero(); // of its corners
  int layer = 0;
};

class VesselWall {
 public:
  VesselWall(VesselMesh mesh, std::vector<WallLayer> layers, const WallOptions& options);

  /// As meshed: use settle() for the shape that its stresses and clamps give it.
  WallState first_state() const;
  /// Steps until the wall stands still to `speed` [m/s]; for scenes at load. Returns the steps taken.
  int settle(WallState& state, int most_steps = 2000, double speed = 1e-5);

  // --- the coming step ---------------------------------------------------------------------------------------------
  void clear_loads() noexcept { n_loads_ = 0; }
  /// Force [N] and stiffness [N/m] (symmetric positive semidefinite) at a material point. At most kMostLoads; more are refused (false).
  bool add_load(const WallState& state, const WallPoint& at, const Vec3& force, const Mat3& stiffness = Mat3::Zero(), const WallSlip& slip = {}) noexcept;
  bool add_load(const WallState& state, const WallPoint& at, const Vec3& force, double stiffness) noexcept {
    return add_load(state, at, force, Mat3(stiffness * Mat3::Identity()));
  }
  /// A rigid thing that stands against a material point: it pushes with stiffness [N/m] times what is left of `depth` [m] (negative: still apart) as the
  /// point gives way along -normal, never pulls. Part of the step's own equilibrium: given as a load it would be on in one step and off in the next.
  /// With `friction` it drags the point along as it moves by `carried` [m] in the step: Coulomb, by the normal force at the step's start, creeping
  /// (nothing is remembered). Returns a number to ask push() with, -1 if there is no room.
  int add_push(const WallState& state, const WallPoint& at, const WallStand& stand) noexcept;
  /// A ball that stands, its centre [m] where it is at the end of the step, against the face of a place that around() found about it: nearest to it wherever
  /// that is within the step. Inside the tissue it stands against the material point. The rest as add_push().
  int add_ball(const WallState& state, const WallCrossing& place, const Vec3& centre, double radius, double stiffness, double friction, const Vec3& carried) noexcept;
  /// [N], of a push on the wall at the end of the last step; 0 for -1.
  Vec3 push(int number) const noexcept { return number < 0 ? Vec3(Vec3::Zero()) : loads_[static_cast<std::size_t>(number)].force(); }
  /// Where the clamp of a part goes during the step; held nodes move with it. Stays until told otherwise.
  void place_clamp(int part, const Pose& X_WC) noexcept { clamp_[static_cast<std::size_t>(part)] = X_WC; }
  /// Transmural pressure [Pa] on the inner faces of a part. Stays until told otherwise.
  void set_pressure(int part, double pressure) noexcept { pressure_[static_cast<std::size_t>(part)] = pressure; }
  /// Finds where the cut edges of different parts may touch in the coming step, from the shape given to refit(). Without it they do not.
  void meet(const WallState& state) noexcept { meetings_.find(mesh_, tree_, state.x); }
  WallSummary step(WallState& state) noexcept;

  // --- questions ---------------------------------------------------------------------------------------------------
  Vec3 position(const WallState& state, const WallPoint& at) const noexcept;  // [m]
  Vec3 velocity(const WallState& state, const WallPoint& at) const noexcept;  // [m/s]
  /// [m], of a point of the surface on its triangles, where crossing() and nearest() see it; the element's side is up to a quarter of its twist beside them.
  Vec3 on_triangle(const WallState& state, const WallPoint& at) const noexcept;
  /// Deformed directions at a point: columns around, along, outward, not of unit length.
  Mat3 directions(const WallState& state, const WallPoint& at) const noexcept;
  int layer_at(const WallPoint& at) const noexcept { return elements_.layer_at(at.element, at.local.z()); }
  /// Depth below the outer surface as share of the wall's thickness: 0 outer, 1 inner.
  double depth_at(const WallPoint& at) const noexcept;
  /// Fits the boxes of the surface to a state; crossing() and near() answer for the state given last.
  void refit(const WallState& state) noexcept;
  /// May some of the surface lie in this box [m]?
  bool near(const Vec3& low, const Vec3& high) const noexcept;
  /// First crossing of the segment from a to b [m] with the surface, after the fraction `from` and up to `until`. Either side counts.
  WallCrossing crossing(const WallState& state, const Vec3& a, const Vec3& b, double from = 0.0, double until = 1.0) const noexcept;
  /// Material point of the surface nearest to q within `reach`; fraction is then the distance [m], negative inside the tissue.
  WallCrossing nearest(const WallState& state, const Vec3& q, double reach) const noexcept;
  /// The same of the surface as it was before the last step, at x - h v; refit() has been told where it is now. `farthest` [m]: what it has moved by at most.
  WallCrossing nearest_before(const WallState& state, const Vec3& q, double reach, double farthest) const noexcept;
  struct SideNormals {
    Vec3 before, now;          // unit, outward
  };
  /// How the surface has turned at a point of it in the last step: normals of the element's side there, of one of them on an edge.
  SideNormals side_normals(const WallState& state, const WallPoint& at) const noexcept;
  /// Triangles that a ball about q of this radius meets or nearly does, each with the place that is nearest to q, the nearest first; only that if q is inside
  /// the tissue. Returns how many, at most `room`.
  int around(const WallState& state, const Vec3& q, double radius, WallCrossing* places, int room) const noexcept;
  /// Material point of the part at q, which lies in the tissue near the point `guess` (Newton's method). found: q is inside.
  WallPoint locate(const WallState& state, const Vec3& q, const WallPoint& guess) const noexcept;

  const VesselMesh& mesh() const noexcept { return mesh_; }
  const std::vector<Triangle>& triangles() const noexcept { return tree_.triangles(); }  // two for each face of the mesh
  const WallElements& elements() const noexcept { return elements_; }
  const WallOptions& options() const noexcept { return options_; }
  int n_parts() const noexcept { return static_cast<int>(clamp_.size()); }
  static constexpr int kMostLoads = 1024;
  static constexpr double kStiff = 1.0;  // [N/m], springs above this come into the first matrix

 private:
  struct OnTriangle {
    Triangle nodes;
    Vec3 weights;              // of them
  };
  OnTriangle triangle_of(const WallPoint& at) const noexcept;
  Vec3 was(const WallState& state, int node) const noexcept { return state.x.col(node) - options_.dt * state.v.col(node); }  // [m], before the last step
  template <class At>
  WallCrossing nearest_of(const WallState& state, const Vec3& q, double reach, double search, const At& at) const noexcept;
  void gather_springs() noexcept;
  std::span<WallLoad> loads() noexcept { return {loads_.data(), static_cast<std::size_t>(n_loads_)}; }
  int add(const WallLoad& load) noexcept;
  WallPlace place_of(const WallPoint& at) const noexcept;
  bool springs_stale() noexcept;
  void find_frames(const Points& x) noexcept;
  void guess(const WallState& state) noexcept;
  bool begin(const WallState& state) noexcept;
  void iterate(WallState& state, WallSummary& summary) noexcept;
  void accept(WallState& state) noexcept;
  void take_forces() noexcept;
  void answer_loads(const Points& x) noexcept;
  double evaluate(const WallState& state) noexcept;  // energy [J] and residual at trial_x_; infinite if an element is inside out
  void precondition(Eigen::VectorXf& b) noexcept;
  void count_springs(const WallHistory& h) noexcept;
  void recall(const WallHistory& h) noexcept;
  void direction(const WallHistory& h) noexcept;
  bool advance(const WallState& state) noexcept;
  void add_pair(WallHistory& h) noexcept;

  VesselMesh mesh_;
  WallOptions options_;
  WallElements elements_;
  double longest_move_ = 0.0;         // [m], of a node in one iteration: the wall's thickness
  double volume_ = 0.0;               // [m3], stress-free
  Eigen::VectorXd inertia_;           // [N/m], of each node, (1 + a h) m / h^2
  std::vector<char> held_;
  std::vector<std::array<int, 6>> neighbours_;  // of each node: inner, outer, before, after, left, right
  std::vector<Mat3> rest_inverse_;              // of the span at rest, by the node's own directions then: outward, along, around
  WallMatrix matrix_;
  WallSprings springs_;
  WallMeetings meetings_;
  SurfaceTree tree_;
  std::vector<Pose> clamp_;
  std::vector<double> pressure_;      // [Pa], of each part
  std::vector<WallLoad> loads_;
  int n_loads_ = 0;
  // scratch of a step
  Points x_, target_, residual_, trial_x_, trial_residual_, push_, trial_push_;  // push: of pressure
  Points elastic_, trial_elastic_;    // [N], of the elements and of pressure
  struct Answer {                     // of the elements alone
    Points x, force;                  // [m], [N]
    std::vector<double> soundness;
    double energy = 0.0;              // [J]
    bool told = false;
    bool is_of(const Points& at, const std::vector<double>& sound) const noexcept { return told && std::equal(at.data(), at.data() + at.size(), x.data()) && sound == soundness; }
  };
  Answer own_, trial_own_, last_;     // last: where the step before ended
  bool pressed_ = false;
  double energy_ = 0.0, trial_energy_ = 0.0, taken_ = 1.0;  // taken: share of the last direction
  std::vector<Mat3> turn_;
  std::vector<Eigen::Matrix3f> single_turn_;  // the same
  Eigen::VectorXd direction_;
  Eigen::VectorXf steer_, turned_;
  WallPairs pairs_;                   // the history's with what springs add in this step
  mutable std::vector<int> found_;
};

}  // namespace filum
