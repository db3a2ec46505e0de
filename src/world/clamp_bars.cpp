#include "world/clamp_bars.h"

namespace filum {
namespace {

constexpr double kBarRadius = 0.22e-3, kBarBelow = 1.15e-3, kBarBeyond = 0.5e-3;  // [m], of the bar; its axis below the vessel's; how far it goes on behind the arms
constexpr double kBehind = 7e-3, kThinner = 0.85;                                 // [m], of vessel behind a clamp; its radius there, of its own

void wholly_ignored(Obstacle& o, bool ignored) noexcept {
  o.ignore_from = ignored ? -1.0 : 1.0;
  o.ignore_to = ignored ? 1.0 : 0.0;
}

RoundBar in_world(const Obstacle& o, const Pose& X) noexcept { return {X * o.a_B, X * o.b_B, o.r_a, o.r_b}; }

constexpr std::size_t kBarsOfClamp = 3;  // two arms, then the vessel behind them

}  // namespace

Pose held_end(const VesselModel& vessel, const ClampState& clamp, int which) noexcept {
  DoubleClamp now = vessel.clamp;
  now.gap = clamp.gap;
  now.turn = clamp.turn;
  const Pose X = stump_poses(now, vessel.shape.stretch * vessel.shape.length)[which == 1 ? 1 : 0];
  return which == 2 ? X * Pose{Vec3(0, 0, 2.0 * vessel.clamp.side->reach), Quat(0, 1, 0, 0)} : X;
}

ClampBars::ClampBars(const VesselModel& vessel) : model_(vessel) { solid_.reserve(2 * static_cast<std::size_t>(n_clamps(vessel)) + 1); }

void ClampBars::add(const ClampState& clamp, double friction, RodObstacles& obstacles) {
  first_body_ = obstacles.bodies.size();
  first_obstacle_ = obstacles.obstacles.size();
  const ClampArms arms = clamp_arms(model_);
  Obstacle o;
  o.friction = friction;
  const auto put = [&](const Vec3& a, const Vec3& b, double r_a, double r_b) {
    o.body = static_cast<int>(obstacles.bodies.size());
    o.a_B = a;
    o.b_B = b;
    o.r_a = r_a;
    o.r_b = r_b;
    obstacles.obstacles.push_back(o);
  };
  const auto at = [&](const Pose& X) { obstacles.bodies.push_back({X, X, X}); };
  for (int k = 0; k < n_clamps(model_); ++k) {
    for (const double side : {-1.0, 1.0}) {
      const Vec3 foot(side * arms.beside, 0, -arms.behind), end = (arms.reach - arms.radius) * Vec3::UnitY();
      put(foot - end, foot + end, arms.radius, arms.radius);
    }
    put(Vec3(0, 0, -arms.behind), Vec3(0, 0, -kBehind), model_.radius, kThinner * model_.radius);
    at(held_end(model_, clamp, k));
  }
  const Vec3 down = kBarBelow * Vec3::UnitZ(), from = held_end(model_, clamp, 0).p - down, to = held_end(model_, clamp, model_.clamp.side ? 2 : 1).p - down;
  const Vec3 beyond = (arms.behind + kBarBeyond) * (to - from).normalized();
  put(from - beyond, to + beyond, kBarRadius, kBarRadius);
  at(Pose());
}

void ClampBars::move(const VesselState& s, RodObstacles& obstacles) noexcept {
  bool all = true;
  for (int k = 0; k < n_clamps(model_); ++k) {
    ObstacleBody& body = obstacles.bodies[first_body_ + static_cast<std::size_t>(k)];
    body.X_start = body.X_end;
    body.X_end = held_end(model_, s.clamp, k);
    all = all && on(s, k);
    for (std::size_t j = 0; j < kBarsOfClamp - 1; ++j) wholly_ignored(obstacles.obstacles[first_obstacle_ + kBarsOfClamp * static_cast<std::size_t>(k) + j], !on(s, k));
  }
  wholly_ignored(obstacles.obstacles[first_obstacle_ + kBarsOfClamp * static_cast<std::size_t>(n_clamps(model_))], !all);
  collect(obstacles);
}

void ClampBars::match(const VesselState& s, RodObstacles& obstacles) noexcept {
  for (int k = 0; k < n_clamps(model_); ++k) {
    ObstacleBody& body = obstacles.bodies[first_body_ + static_cast<std::size_t>(k)];
    body.X_start = body.X_end = body.X_now = held_end(model_, s.clamp, k);
  }
  move(s, obstacles);
}

void ClampBars::collect(const RodObstacles& obstacles) noexcept {
  solid_.clear();
  const auto take = [&](std::size_t k) {
    const Obstacle& o = obstacles.obstacles[first_obstacle_ + k];
    if (o.ignore_from > o.ignore_to) solid_.push_back(in_world(o, obstacles.bodies[static_cast<std::size_t>(o.body)].X_end));
  };
  for (int k = 0; k < n_clamps(model_); ++k)
    for (std::size_t j = 0; j < kBarsOfClamp - 1; ++j) take(kBarsOfClamp * static_cast<std::size_t>(k) + j);
  take(kBarsOfClamp * static_cast<std::size_t>(n_clamps(model_)));
}

}  // namespace filum
