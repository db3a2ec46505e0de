#include "physics/rod_obstacle.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "base/stage_clock.h"
#include "collision/segment_distance.h"

namespace filum {
namespace {

constexpr int kChunk = 8;          // edges in one box of the broad phase
constexpr double kDeepest = 16.0;  // [radii], of the thread in a body that comes upon it: as far as a node moves in an iteration
constexpr double kDeeper = 8.0;    // [radii], by which a body goes on that thread is in the way of: less than the thread can get away by
constexpr double kFar = 0.5;       // of a bar's radius
constexpr double kArc = 1.5;       // of the straight way: more than that of a point that is turned by up to 170 degrees

double bar_radius(const Obstacle& o, double t) noexcept { return (1.0 - t) * o.r_a + t * o.r_b; }

/// [m2], of pressed_on_bar: only the edge's point wanders, where two edges share it.
double spread(const Obstacle& o, double radius) noexcept { return 2.0 * push_spread(radius + std::max(o.r_a, o.r_b), radius); }

/// Distance of the axes that a single move may not undercut: a fresh touch is met at the surface, where the contact force can
/// answer it, not deep inside.
double closest_allowed(double touching, double distance, double radius) noexcept {
  return std::min(touching - 0.3 * radius, 0.95 * distance);
}

/// [m], how far the end of a bar comes off its straight way as its body turns. Below 0.1 rad it is small against a bar's radius and not counted.
double bulge(const ObstacleBody& body, const Obstacle& o) noexcept {
  const double turn = body.X_now.q.angularDistance(body.X_end.q);
  return turn < 0.1 ? 0.0 : 0.125 * turn * turn * std::max(o.a_B.norm(), o.b_B.norm());
}

/// Distance of the axes [m] at which a body stops for this iteration, so that thread can get out of its way.
double closest_for_now(double touching, double distance, double radius, double bulge) noexcept {
  const double fresh = std::max(0.6 * touching, touching - kDeepest * radius) + bulge;
  return std::min(fresh, std::max(0.8 * distance, distance - kDeeper * radius));
}

Pose between(const Pose& from, const Pose& to, double f) noexcept {
  return {(1.0 - f) * from.p + f * to.p, from.q.slerp(f, to.q)};
}

void add_block(const ObstacleTouch& t, const Mat3& k, const ChainSlots& chain, BlockCholesky& matrix) noexcept {
  matrix.add_diagonal(t.edge, pad((1.0 - t.s) * (1.0 - t.s) * k));
  matrix.add_diagonal(t.edge + 1, pad(t.s * t.s * k));
  matrix.add(chain.next[t.edge], pad(t.s * (1.0 - t.s) * k));
}

/// Contact spring of a wall: like the strands' own but without the barrier, since a bar is thick.
PairPotential wall(double gap, double radius, const ContactMaterial& m) noexcept { return squeeze(-gap, radius, m.wall_ratio * m.stiffness); }

}  // namespace

RodObstacles::RodObstacles(int touch_capacity) {
  touches_.reserve(static_cast<std::size_t>(touch_capacity));
  known_.reserve(static_cast<std::size_t>(touch_capacity));
}

void RodObstacles::collect(int edge, int obstacle, double s, double gap) noexcept {
  if (touches_.size() == touches_.capacity()) return;
  ObstacleTouch& t = touches_.emplace_back();
  t.edge = edge;
  t.obstacle = obstacle;
  t.s = s;
  t.gap = gap;
}

void RodObstacles::place(std::size_t obstacle) noexcept {
  const Obstacle& o = obstacles[obstacle];
  const Pose& X = bodies[static_cast<std::size_t>(o.body)].X_now;
  a_W_[obstacle] = X * o.a_B;
  b_W_[obstacle] = X * o.b_B;
}

void RodObstacles::find_touches(const RodState& s, const Points& x, double radius, const Eigen::VectorXd& reach) noexcept {
  std::swap(touches_, known_);
  touches_.clear();
  a_W_.resize(obstacles.size());
  b_W_.resize(obstacles.size());
  gone_.assign(obstacles.size(), 0.0);
  near_.reserve(obstacles.size());
  way_.resize(obstacles.size());
  double tips = 0.0;
  for (const ObstacleBody& b : bodies) tips = std::max(tips, (b.X_end.p - b.X_start.p).norm());
  for (std::size_t k = 0; k < obstacles.size(); ++k) {
    place(k);
    way_[k] = kArc * std::max(tips, sweep(k));
  }
  double arc = s.arc_start;
  for (int begin = 0; begin + 1 < s.n; begin += kChunk) {
    const int end = std::min(begin + kChunk, s.n - 1);
    const auto nodes = x.middleCols(begin, end - begin + 1);
    find_near_obstacles(nodes.rowwise().minCoeff(), nodes.rowwise().maxCoeff(), radius + reach.segment(begin, end - begin).maxCoeff());
    for (int j = begin; j < end; arc += s.rest_length[j++])
      for (const int k : near_)
        if (arc + s.rest_length[j] <= obstacles[k].ignore_from || arc >= obstacles[k].ignore_to)
          find_touch(s, x, radius, radius + reach[j] + way_[k], j, k);
  }
  keep_loads();
}

/// How far any point of a bar goes until its body is at X_end (none farther than an end of its axis), where that is far for its radius: the shaft behind a tip
/// that stays. One that comes on by less is found in the next step, the thread still before it; bars that only turn past would hold their bodies up. [m]
double RodObstacles::sweep(std::size_t obstacle) const noexcept {
  const Obstacle& o = obstacles[obstacle];
  const Pose& X = bodies[static_cast<std::size_t>(o.body)].X_end;
  const double far = std::max((X * o.a_B - a_W_[obstacle]).norm(), (X * o.b_B - b_W_[obstacle]).norm());
  return far > kFar * std::max(o.r_a, o.r_b) ? far : 0.0;
}

/// Those that come within `margin` [m] of the box of some nodes.
void RodObstacles::find_near_obstacles(const Vec3& low, const Vec3& high, double margin) noexcept {
  near_.clear();
  for (int k = 0; k < static_cast<int>(obstacles.size()); ++k)
    if (obstacles[k].kind == Obstacle::Kind::plane || !beyond(low, high, k, margin + way_[k])) near_.push_back(k);
}

/// The box of a bar's axis is farther from that box than margin and the bar's radius.
bool RodObstacles::beyond(const Vec3& low, const Vec3& high, int k, double margin) const noexcept {
  const double near = margin + std::max(obstacles[k].r_a, obstacles[k].r_b);
  return ((low - a_W_[k].cwiseMax(b_W_[k])).array() > near).any() || ((a_W_[k].cwiseMin(b_W_[k]) - high).array() > near).any();
}

void RodObstacles::find_touch(const RodState& s, const Points& x, double radius, double margin, int j, int k) noexcept {
  const Obstacle& o = obstacles[k];
  if (o.kind == Obstacle::Kind::plane) {
    const Vec3 n = (b_W_[k] - a_W_[k]).normalized();
    const double above = n.dot(x.col(j) - a_W_[k]), last = n.dot(x.col(j + 1) - a_W_[k]);
    if (above < margin) collect(j, k, 0.0, above - radius);
    if (o.bears_end && j + 2 == s.n && last < margin) collect(j, k, 1.0, last - radius);
    return;
  }
  if (s.alive[j] == 0) return;  // of a parted edge only the first node counts: it ends a piece that may lie on the sheet
  if (beyond(x.col(j).cwiseMin(x.col(j + 1)), x.col(j).cwiseMax(x.col(j + 1)), k, margin)) return;
  const SegmentPair c = closest_points(x.col(j), x.col(j + 1), a_W_[k], b_W_[k]);
  if (c.distance < margin + bar_radius(o, c.t)) collect(j, k, c.s, c.distance - radius - std::max(o.r_a, o.r_b));
}

void RodObstacles::keep_loads() noexcept {
  auto q = known_.begin();  // both are sorted by edge and obstacle
  for (ObstacleTouch& t : touches_) {
    while (q != known_.end() && std::tie(q->edge, q->obstacle) < std::tie(t.edge, t.obstacle)) ++q;
    t.load = q != known_.end() && q->edge == t.edge && q->obstacle == t.obstacle ? q->load : 0.0;
  }
}

void RodObstacles::recall(const std::vector<ContactBristle>& memory) noexcept {
  auto b = memory.begin();
  for (ObstacleTouch& t : touches_) {
    while (b != memory.end() && std::tie(b->i, b->j) < std::tie(t.edge, t.obstacle)) ++b;
    t.xi_start.setZero();
    if (b == memory.end() || b->i != t.edge || b->j != t.obstacle) continue;
    const ObstacleBody& body = bodies[static_cast<std::size_t>(obstacles[static_cast<std::size_t>(t.obstacle)].body)];
    t.xi_start = body.X_end.q * (body.X_start.q.conjugate() * b->xi);
  }
}

void RodObstacles::remember(std::vector<ContactBristle>& memory) const noexcept {
  memory.clear();
  for (const ObstacleTouch& t : touches_) {
    if (t.force <= 0.0 || memory.size() == memory.capacity()) continue;
    memory.push_back({t.edge, t.obstacle, t.friction.xi, t.force});
  }
}

bool RodObstacles::advance_bodies(const Points& x, double radius) noexcept {
  bool there = true;
  for (int b = 0; b < static_cast<int>(bodies.size()); ++b) {
    ObstacleBody& body = bodies[static_cast<std::size_t>(b)];
    if (body.X_now.p == body.X_end.p && body.X_now.q.coeffs() == body.X_end.q.coeffs()) continue;
    double fraction = 1.0;
    for (const ObstacleTouch& t : touches_) {
      const Obstacle& o = obstacles[static_cast<std::size_t>(t.obstacle)];
      if (o.body != b || o.kind == Obstacle::Kind::plane) continue;
      const Vec3 ends[4] = {x.col(t.edge), x.col(t.edge + 1), body.X_now * o.a_B, body.X_now * o.b_B};
      const Vec3 moves[4] = {Vec3::Zero(), Vec3::Zero(), body.X_end * o.a_B - ends[2], body.X_end * o.b_B - ends[3]};
      const SegmentPair c = closest_points(ends[0], ends[1], ends[2], ends[3]);
      const double keep = closest_for_now(radius + bar_radius(o, c.t), c.distance, radius, bulge(body, o));
      fraction = std::min(fraction, conservative_advance(ends, moves, keep));
    }
    body.X_now = fraction >= 1.0 ? body.X_end : between(body.X_now, body.X_end, fraction);
    there = there && fraction >= 1.0;
    carry_bars(b);
  }
  return there;
}

/// Puts the obstacles of a body where it is now.
void RodObstacles::carry_bars(int body) noexcept {
  for (std::size_t k = 0; k < obstacles.size(); ++k) {
    if (obstacles[k].body != body) continue;
    const Vec3 a = a_W_[k], b = b_W_[k];
    place(k);
    gone_[k] += std::max((a_W_[k] - a).norm(), (b_W_[k] - b).norm());
  }
}

void RodObstacles::measure(const Points& x, double radius, ObstacleTouch& touch) const noexcept {
  const auto k = static_cast<std::size_t>(touch.obstacle);
  const Obstacle& o = obstacles[k];
  if (o.kind == Obstacle::Kind::plane) {
    touch.normal = (b_W_[k] - a_W_[k]).normalized();
    touch.gap = touch.normal.dot(x.col(touch.edge + (touch.s > 0.5)) - a_W_[k]) - radius;
    return;
  }
  const SegmentPair c = pressed_on_bar(x.col(touch.edge), x.col(touch.edge + 1), a_W_[k], b_W_[k], o.r_a, o.r_b, spread(o, radius));
  touch.s = c.s;
  touch.t = c.t;
  touch.normal = c.d / std::max(c.d.norm(), 1e-12);
  touch.gap = c.distance - radius - bar_radius(o, c.t);
}

Vec3 RodObstacles::trial_bristle(const ObstacleTouch& t, const Points& x, const Points& x_start) const noexcept {
  const Vec3 now = (1.0 - t.s) * x.col(t.edge) + t.s * x.col(t.edge + 1);
  const Vec3 before = (1.0 - t.s) * x_start.col(t.edge) + t.s * x_start.col(t.edge + 1);
  const ObstacleBody& body = bodies[static_cast<std::size_t>(obstacles[static_cast<std::size_t>(t.obstacle)].body)];
  const Vec3 carried = body.X_now * (body.X_start.inverse() * before);  // where the body has taken that point
  const Vec3 xi = t.xi_start + now - carried;
  return xi - xi.dot(t.normal) * t.normal;
}

void RodObstacles::update(const Points& x, double radius, const ContactMaterial& m, const RodTravel& travel, FrictionLoad load) noexcept {
  const StageScope stage("contact laws");
  for (ObstacleTouch& t : touches_) {
    if (obstacles[static_cast<std::size_t>(t.obstacle)].kind == Obstacle::Kind::bar && at_least(t, travel) > 0.0) {
      t.force = t.load = 0.0;
      continue;
    }
    measure(x, radius, t);
    t.measured_at = gone(t, travel);
    t.force = -wall(t.gap, radius, m).slope;
    t.load = friction_load(load, t.load, t.force);
  }
}

double RodObstacles::energy(const Points& x, const Points& x_start, double radius, const ContactMaterial& m, const RodTravel& travel,
                            double fraction) const noexcept {
  double u = 0.0;
  for (const ObstacleTouch& t : touches_) {
    if (at_least(t, travel) > fraction * travel.stride(t.edge)) continue;
    ObstacleTouch trial = t;
    measure(x, radius, trial);
    u += wall(trial.gap, radius, m).energy;
    const double mu = obstacles[static_cast<std::size_t>(t.obstacle)].friction;
    if (t.force > 0.0) u += coulomb(trial_bristle(t, x, x_start), t.normal, t.load, mu, m.stick(mu, t.load)).energy;
  }
  return u;
}

void RodObstacles::add_gradient(const Points& x, const Points& x_start, double radius, const ContactMaterial& m,
                                Eigen::Matrix4Xd& gradient) noexcept {
  for (ObstacleBody& b : bodies) b.force = b.torque = Vec3::Zero();
  for (ObstacleTouch& t : touches_) {
    if (t.force <= 0.0) continue;
    const Obstacle& o = obstacles[static_cast<std::size_t>(t.obstacle)];
    t.trial = trial_bristle(t, x, x_start);
    t.friction = coulomb(t.trial, t.normal, t.load, o.friction, m.stick(o.friction, t.load));
    const Vec3 on_thread = t.force * t.normal + t.friction.force;
    gradient.col(t.edge).head<3>() -= (1.0 - t.s) * on_thread;
    gradient.col(t.edge + 1).head<3>() -= t.s * on_thread;
    ObstacleBody& body = bodies[static_cast<std::size_t>(o.body)];
    const Vec3 point = (1.0 - t.s) * x.col(t.edge) + t.s * x.col(t.edge + 1) - radius * t.normal;
    body.force -= on_thread;
    body.torque -= (point - body.X_now.p).cross(on_thread);
  }
}

void RodObstacles::add_stiffness(const Points& x, double radius, const ContactMaterial& m, const ChainSlots& chain,
                                 BlockCholesky& matrix) const noexcept {
  for (const ObstacleTouch& t : touches_) {
    if (t.force <= 0.0) continue;
    const Mat3 k = wall(t.gap, radius, m).curvature * t.normal * t.normal.transpose() + t.friction.stiffness;
    add_block(t, k, chain, matrix);
    const auto b = static_cast<std::size_t>(t.obstacle);
    if (obstacles[b].kind == Obstacle::Kind::plane || t.s <= 0.0 || t.s >= 1.0) continue;
    const Vec3 u = x.col(t.edge + 1) - x.col(t.edge), v = b_W_[b] - a_W_[b];
    const double slides = t.t > 0.0 && t.t < 1.0 ? u.dot(v) * u.dot(v) / v.squaredNorm() : 0.0;
    const double distance = t.gap + radius + bar_radius(obstacles[b], t.t);
    const double turning = t.force * distance / (u.squaredNorm() + spread(obstacles[b], radius) - slides);  // as in RodContact::add_turn
    const Mat4 block = pad(turning * t.normal * t.normal.transpose());
    matrix.add_diagonal(t.edge, block);
    matrix.add_diagonal(t.edge + 1, block);
    matrix.add(chain.next[t.edge], -block);
  }
}

double RodObstacles::free_fraction(const Points& x, const Eigen::Matrix4Xd& move, double radius, const RodTravel& travel) const noexcept {
  double fraction = 1.0;
  for (const ObstacleTouch& t : touches_) {
    const auto k = static_cast<std::size_t>(t.obstacle);
    if (obstacles[k].kind == Obstacle::Kind::plane || at_least(t, travel) > travel.stride(t.edge)) continue;
    const Vec3 ends[4] = {x.col(t.edge), x.col(t.edge + 1), a_W_[k], b_W_[k]};
    const Vec3 moves[4] = {fraction * move.col(t.edge).head<3>(), fraction * move.col(t.edge + 1).head<3>(), Vec3::Zero(),
                           Vec3::Zero()};
    const SegmentPair c = closest_points(ends[0], ends[1], ends[2], ends[3]);
    const double keep = closest_allowed(radius + bar_radius(obstacles[k], c.t), c.distance, radius);
    if (std::max(moves[0].norm(), moves[1].norm()) <= c.distance - keep) continue;
    fraction *= conservative_advance(ends, moves, keep);
  }
  return fraction;
}

}  // namespace filum
