#pragma once
// What acts on a wall at one place during its step, as a part of the step's energy U(x) (vessel_wall.h):
//   spring  U = -(f - 1/2 K u) . u + friction of what slides through the place (WallSlip),   u = how far the place has moved
//   stop    U = k/2 o^2,  o = max(0, depth + n . u):  a rigid thing that stands against a material point, with its normal n
//   ball    U = k/2 o^2,  o = max(0, r - d(x)):  one that stands against a triangle, d the distance of its centre from that triangle as it lies at x
// d's gradient by a corner is the foot's weight there times the unit vector from the centre to the foot (envelope theorem: the foot moves along the
// triangle, which changes d to second order only), so that a face that tilts under a ball is met where it is nearest at any time within the step. Met at the
// foot of the step's start, it would dip into the ball beside it, be pushed back there in the next step, and so on, for ever.
// Stop and ball push only, and drag by friction: Coulomb by the normal force at the step's start, regularised by a bristle,
//   U = s/2 |w|^2 up to limit = s |w|, then limit (|w| - limit / 2s),   w = u - carried, in the plane across n,   u of the place at the start.
// Test: wall_load_test.

#include <array>

#include "physics/vessel_mesh.h"

namespace filum {

/// Dry friction of what slides through a material point, along `along`: force - stick m within [low, high] as the point moves by m. A force that stayed what
/// it was would drag a soft wall far past what it rubs on, to be dragged back in the next step.
struct WallSlip {
  Vec3 along = Vec3::Zero();   // unit
  double force = 0.0;          // [N], on the wall at the start of its step
  double stick = 0.0;          // [N/m]
  double low = 0.0, high = 0.0;  // [N]
};

/// A place: up to eight nodes and their weights, whose sum is one.
struct WallPlace {
  std::array<int, 8> node{};
  Eigen::Matrix<double, 8, 1> weight = Eigen::Matrix<double, 8, 1>::Zero();

  Vec3 at(const Points& x) const noexcept {
    Vec3 sum = Vec3::Zero();
    for (int a = 0; a < 8; ++a) sum += weight[a] * x.col(node[static_cast<std::size_t>(a)]);
    return sum;
  }
};

/// How a rigid thing stands against a wall.
struct WallStand {
  Vec3 normal = Vec3::Zero();   // unit, from the wall towards it, at the step's start
  double depth = 0.0;           // [m], of its overlap then; negative: apart
  double stiffness = 0.0;       // [N/m]
  double friction = 0.0;        // [-]
  Vec3 carried = Vec3::Zero();  // [m], by which it moves in the step
};

class WallLoad {
 public:
  WallLoad() = default;
  /// Force [N] and stiffness [N/m], symmetric and positive semidefinite, at a place; x are the nodes [m] at the step's start.
  static WallLoad spring(const WallPlace& place, const Points& x, const Vec3& force, const Mat3& stiffness, const WallSlip& slip) noexcept;
  static WallLoad stop(const WallPlace& place, const Points& x, const WallStand& stand) noexcept;
  /// Of a triangle, with the weights of the foot at the step's start.
  static WallLoad ball(const Triangle& triangle, const Vec3& weights, const Points& x, const WallStand& stand, const Vec3& centre, double radius) noexcept;

  /// What it does to the wall at x from now on. Returns its energy [J].
  double answer(const Points& x) noexcept;
  void add_to(Points& force) const noexcept;                        // [N]
  Vec3 force() const noexcept { return push_ + drag_; }             // [N], on the wall

  /// A number that changes as what it feels like does: it comes to touch, sticks, slips or leaves.
  int phase() const noexcept { return kind_ == Kind::spring ? (sticks_ ? 2 : 1) : (pushed_ > 0.0 ? 2 : 0); }
  const WallPlace& place() const noexcept { return place_; }        // where it acts at present
  Mat3 felt() const noexcept;                                       // [N/m], there

  // What the wall's solver knows of it, for the solver to keep
  struct Known {
    int phase = 0;
    WallPlace place;
    Mat3 stiffness = Mat3::Zero();  // [N/m]
  };
  Known counted;                    // by the pairs
  int gathered = 0;                 // phase, by the first matrix

 private:
  enum class Kind { spring, stop, ball };

  void stand_against(const WallStand& stand) noexcept;
  double answer_spring(const Points& x) noexcept;
  double answer_stop(const Points& x) noexcept;
  double answer_ball(const Points& x) noexcept;
  double push(double overlap, const Vec3& way) noexcept;
  double rub(const Vec3& moved) noexcept;

  Kind kind_ = Kind::spring;
  WallPlace place_, first_;         // first: at the step's start
  Vec3 at_ = Vec3::Zero();          // [m], then
  Vec3 push_ = Vec3::Zero(), drag_ = Vec3::Zero();  // [N], at place_, at first_
  // spring
  Vec3 given_ = Vec3::Zero();       // [N]
  Mat3 stiffness_ = Mat3::Zero();   // [N/m]
  WallSlip slip_;
  bool sticks_ = false;
  // stop and ball
  WallStand stand_;
  Vec3 way_ = Vec3::Zero();         // unit, of the push: outward
  double pushed_ = 0.0, stick_ = 0.0, limit_ = 0.0;  // [N], [N/m], [N]
  Vec3 centre_ = Vec3::Zero();      // [m]
  double radius_ = 0.0;             // [m]
};

}  // namespace filum
