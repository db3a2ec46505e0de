#pragma once
// Contact of the thread with rigid things: jaws and shafts of instruments and the practice post (capsules, round bars whose
// radius may taper) and the background sheet (plane). Normal force k o^2/2 as in rod_contact.h, friction as in friction.h with
// the displacement taken relative to the moving body. The forces on the bodies are summed about their origins.
// Neglects: the small tilt of the normal on a tapered bar; squeeze of the bodies. Test: rod_obstacle_test.

#include <vector>

#include "physics/rod_contact.h"

namespace filum {

/// A body that the thread can touch. Its pose goes from X_start to X_end within the step; X_now is where it is at present.
struct ObstacleBody {
  Pose X_start, X_end, X_now;
  Vec3 force = Vec3::Zero();   // [N], of the thread on the body, frame W, after the step
  Vec3 torque = Vec3::Zero();  // [N m], about the origin of X_now
};

/// A round bar fixed to a body, or a plane (normal b - a through a, r_a = r_b = 0) that nodes rest on.
struct Obstacle {
  enum class Kind { bar, plane };
  Kind kind = Kind::bar;
  int body = 0;
  Vec3 a_B = Vec3::Zero(), b_B = Vec3::UnitZ();  // [m], ends of the axis in the body's frame
  double r_a = 0, r_b = 0;                        // [m]
  double friction = 0.2;                          // [-]
  double ignore_from = 1.0, ignore_to = 0.0;      // [m], stretch of the thread it does not touch (held in the jaws), by arc
  bool bears_end = true;                          // a plane: the last node lies on it; false where that is inside a needle's swage
};

struct ObstacleTouch {
  int edge = 0, obstacle = 0;
  double s = 0, t = 0;                // along the edge, along the bar
  Vec3 normal = Vec3::UnitZ();        // unit, from the obstacle to the thread
  double gap = 1;                     // [m], at least, between the surfaces when edge and bar had gone `measured_at` [m]
  double measured_at = 0;
  double force = 0;                   // [N], normal
  double load = 0;                    // [N], normal force by which friction goes, see FrictionLoad
  Vec3 xi_start = Vec3::Zero();       // [m], turned with the body
  Vec3 trial = Vec3::Zero();          // [m], bristle before return mapping
  FrictionPoint friction;
};

class RodObstacles {
 public:
  explicit RodObstacles(int touch_capacity);

  std::vector<ObstacleBody> bodies;
  std::vector<Obstacle> obstacles;

  /// Collects what could touch while each edge moves at most reach[edge] [m] from where it is and every body goes on to X_end. Touches known before
  /// keep their load of friction, others have none.
  void find_touches(const RodState& s, const Points& x, double radius, const Eigen::VectorXd& reach) noexcept;
  void recall(const std::vector<ContactBristle>& memory) noexcept;
  void remember(std::vector<ContactBristle>& memory) const noexcept;

  /// Moves every body on towards X_end as far as the thread at x lets it without being jumped over. True when all are there.
  bool advance_bodies(const Points& x, double radius) noexcept;

  /// Measures what can touch by now; the rest has no force. `travel`: of the thread since find_touches().
  void update(const Points& x, double radius, const ContactMaterial& m, const RodTravel& travel, FrictionLoad load) noexcept;
  /// Potential [J] at x, `fraction` of the travel's move in question from where the nodes were at the last update.
  double energy(const Points& x, const Points& x_start, double radius, const ContactMaterial& m, const RodTravel& travel,
                double fraction) const noexcept;
  void add_gradient(const Points& x, const Points& x_start, double radius, const ContactMaterial& m,
                    Eigen::Matrix4Xd& gradient) noexcept;
  void add_stiffness(const Points& x, double radius, const ContactMaterial& m, const ChainSlots& chain,
                     BlockCholesky& matrix) const noexcept;
  double free_fraction(const Points& x, const Eigen::Matrix4Xd& move, double radius, const RodTravel& travel) const noexcept;

  const std::vector<ObstacleTouch>& touches() const noexcept { return touches_; }
  /// [m], the gap is not smaller than this.
  double at_least(const ObstacleTouch& t, const RodTravel& travel) const noexcept { return t.gap - (gone(t, travel) - t.measured_at); }

 private:
  void measure(const Points& x, double radius, ObstacleTouch& touch) const noexcept;
  Vec3 trial_bristle(const ObstacleTouch& touch, const Points& x, const Points& x_start) const noexcept;
  double gone(const ObstacleTouch& t, const RodTravel& travel) const noexcept {
    const auto k = static_cast<std::size_t>(t.obstacle);
    return obstacles[k].kind == Obstacle::Kind::plane ? 0.0 : travel.gone(t.edge) + gone_[k];  // planes are always measured
  }
  void find_near_obstacles(const Vec3& low, const Vec3& high, double margin) noexcept;
  bool beyond(const Vec3& low, const Vec3& high, int obstacle, double margin) const noexcept;
  void find_touch(const RodState& s, const Points& x, double radius, double margin, int edge, int obstacle) noexcept;
  void keep_loads() noexcept;
  void collect(int edge, int obstacle, double s, double gap) noexcept;
  void place(std::size_t obstacle) noexcept;
  double sweep(std::size_t obstacle) const noexcept;
  void carry_bars(int body) noexcept;

  std::vector<ObstacleTouch> touches_, known_;
  std::vector<Vec3> a_W_, b_W_;  // [m], axis ends of each obstacle at X_now
  std::vector<int> near_;
  std::vector<double> way_;      // [m], how far they may move
  std::vector<double> gone_;     // [m], how far they have moved since find_touches()
};

}  // namespace filum
