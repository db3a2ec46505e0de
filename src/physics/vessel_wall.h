#pragma once
// A layered vessel wall (or card) that moves: backward Euler by quasi-Newton steps.
//
//   find x:  M ((1 + a h)(x - x_n) - h v_n) / h^2 = f_elastic(x) + f_pressure(x) + f_loads(x),   v = (x - x_n)/h
// solved with limited-memory BFGS whose first matrix is P = M (1 + a h)/h^2 + K at rest, factored once (Liu, Bouaziz & Kavan, ACM
// TOG 36:23, 2017; P turned node by node into the wall's present directions, so that a stump that is turned over or an
// edge that is everted meets a matrix of its own orientation). Follower pressure on inner faces. Loads at material points are
// f + k (x_0 - x), x_0 where the point was when the load was given: needle, thread, jaws and contact come in by them.
// State is complete: same state, same loads, same next state. A step allocates nothing.
// Neglects: viscoelasticity (a damps against the surroundings only), fluid inertia. Tests: vessel_wall_test, vessel_wall_surface_test.

#include <memory>
#include <vector>

#include "collision/surface_tree.h"
#include "physics/vessel_wall_element.h"
#include "physics/vessel_wall_factor.h"
#include "physics/vessel_wall_springs.h"
#include "physics/wall_meeting.h"
#include "physics/wall_state.h"

namespace filum {

struct WallOptions {
  double dt = 2e-3;            // [s]
  double density = 1060.0;     // [kg/m3]
  double damping = 100.0;      // [1/s], against the surroundings
  double tolerance = 1e-5;     // [N], largest unbalanced force of a node
  int max_iterations = 8;
  int memory = 5;              // pairs of the BFGS history
  bool single_precision = true;  // of the elements' forces
};

struct WallSummary {
  bool converged = false;
  bool sound = true;           // all numbers finite; a step that is not leaves the wall where it was, at rest
  int iterations = 0;
  double residual = 0.0;       // [N]
};

struct WallCrossing {
  bool found = false;
  WallPoint point;
  WallSurface surface = WallSurface::inner;
  double fraction = 1.0;       // along the segment
  Vec3 normal = Vec3::Zero();  // unit, outward from the tissue
  int triangle = -1;           // of triangles()
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
  bool add_load(const WallState& state, const WallPoint& at, const Vec3& force, const Mat3& stiffness = Mat3::Zero()) noexcept;
  bool add_load(const WallState& state, const WallPoint& at, const Vec3& force, double stiffness) noexcept {
    return add_load(state, at, force, Mat3(stiffness * Mat3::Identity()));
  }
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
  /// Deformed directions at a point: columns around, along, outward, not of unit length.
  Mat3 directions(const WallState& state, const WallPoint& at) const noexcept;
  int layer_at(const WallPoint& at) const noexcept { return elements_.layer_at(at.element, at.local.z()); }
  /// Depth below the outer surface as share of the wall's thickness: 0 outer, 1 inner.
  double depth_at(const WallPoint& at) const noexcept;
  /// Fits the boxes of the surface to a state; crossing() and near() answer for the state given last.
  void refit(const WallState& state) noexcept;
  /// First crossing of the segment from a to b [m] with the surface, after the fraction `from`. Either side counts.
  WallCrossing crossing(const WallState& state, const Vec3& a, const Vec3& b, double from = 0.0) const noexcept;
  /// Material point of the surface nearest to q within `reach`; fraction is then the distance [m], negative inside the tissue.
  WallCrossing nearest(const WallState& state, const Vec3& q, double reach) const noexcept;
  /// Material point of the part at q, which lies in the tissue near the point `guess` (Newton's method). found: q is inside.
  WallPoint locate(const WallState& state, const Vec3& q, const WallPoint& guess) const noexcept;

  const VesselMesh& mesh() const noexcept { return mesh_; }
  const std::vector<Triangle>& triangles() const noexcept { return tree_.triangles(); }  // two for each face of the mesh
  const WallElements& elements() const noexcept { return elements_; }
  const WallOptions& options() const noexcept { return options_; }
  int n_parts() const noexcept { return static_cast<int>(clamp_.size()); }
  static constexpr int kMostLoads = 1024;

 private:
  struct Load {
    std::array<int, 8> node;
    Eigen::Matrix<double, 8, 1> weight;
    Vec3 force, at;
    Mat3 stiffness;
  };
  struct Pair {
    Eigen::VectorXd s, y;
    double inverse = 0.0;  // 1 / (s . y)
  };

  void gather_springs() noexcept;
  void find_frames(const Points& x) noexcept;
  void guess(const WallState& state) noexcept;
  double evaluate(const WallState& state) noexcept;  // energy [J] and residual at trial_x_; infinite if an element is inside out
  void precondition(const Eigen::VectorXd& r, Eigen::VectorXd& d) noexcept;
  void direction() noexcept;
  bool advance(const WallState& state) noexcept;
  void add_pair() noexcept;

  VesselMesh mesh_;
  WallOptions options_;
  WallElements elements_;
  double longest_move_ = 0.0;         // [m], of a node in one iteration: the wall's thickness
  Eigen::VectorXd inertia_;           // [N/m], of each node, (1 + a h) m / h^2
  std::vector<char> held_;
  std::vector<std::array<int, 4>> neighbours_;  // of each node: inner, outer, before, after
  std::vector<Mat3> rest_frame_;
  SlabFactor factor_;
  WallSprings springs_;
  WallMeetings meetings_;
  SurfaceTree tree_;
  std::vector<Pose> clamp_;
  std::vector<double> pressure_;      // [Pa], of each part
  std::vector<Load> loads_;
  int n_loads_ = 0;
  // scratch of a step
  Points x_, target_, residual_, trial_x_, trial_residual_, push_, trial_push_;  // push: of pressure
  bool pressed_ = false;
  double energy_ = 0.0, trial_energy_ = 0.0, taken_ = 1.0;  // taken: share of the last direction
  std::vector<Mat3> turn_;
  Eigen::VectorXd direction_, work_;
  Eigen::VectorXf turned_f_;
  std::vector<Pair> pairs_;
  int n_pairs_ = 0, newest_ = -1;
  mutable std::vector<int> found_;
};

}  // namespace filum
