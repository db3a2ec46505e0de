#include "haptics/hand_coupling.h"

#include <algorithm>
#include <cmath>

namespace filum {

void HandCoupling::release() noexcept {
  started_ = false;
  force_.setZero();
  v_D_.setZero();
}

/// Books what the last force spent on the way to p_D; returns the way.
Vec3 HandCoupling::moved_to(const Vec3& p_D, double dt) noexcept {
  if (!started_) p_D_ = p_D;
  started_ = true;
  const Vec3 moved = p_D - p_D_;
  tank_ = std::min(tank_ - force_.dot(moved), options_.tank_size);
  const double blend = dt / (dt + 1.0 / options_.velocity_cutoff);
  v_D_ += blend * (moved / dt - v_D_);
  p_D_ = p_D;
  return moved;
}

Vec3 HandCoupling::pass(const Vec3& wanted, const Vec3& p_D, double dt) noexcept {
  const Vec3 moved = moved_to(p_D, dt);
  force_ = affordable(limited(wanted, dt), moved, dt);
  return force_;
}

Vec3 HandCoupling::force(const Vec3& p_D, const Vec3& p_T, const Vec3& v_T, double dt) noexcept {
  const Vec3 moved = moved_to(p_D, dt);
  const Vec3 wanted = options_.stiffness * (p_T - p_D) + options_.damping * (v_T - v_D_);
  force_ = affordable(limited(wanted, dt), moved, dt);
  return force_;
}

Vec3 HandCoupling::limited(const Vec3& wanted, double dt) const noexcept {
  const double size = wanted.norm();
  const Vec3 target = size > options_.force_limit ? Vec3(wanted * (options_.force_limit / size)) : wanted;
  const Vec3 change = target - force_;
  const double most = options_.slew_limit * dt;
  // Both ends lie in the ball of the force limit, so every point between them does too.
  return change.norm() > most ? Vec3(force_ + change * (most / change.norm())) : target;
}

/// Scales the force by s so that what it may spend until the next call, s a + s^2 b, is at most what the tank
/// holds. This comes after the limit on the rate of change: safe before smooth.
Vec3 HandCoupling::affordable(const Vec3& force, const Vec3& moved, double dt) noexcept {
  const double straight_on = force.dot(moved);  // [J], if the hand goes on as it went
  const double a = straight_on > 0.0 ? 2.0 * straight_on : 0.5 * straight_on;  // it may speed up or slow down
  const double b = force.squaredNorm() * dt * dt / (2.0 * options_.lightest_hand);  // [J], where it is pushed
  const double budget = std::max(tank_, 0.0);
  if (a + b <= budget || b == 0.0) return force;
  ++held_back_;
  const double scale = (std::sqrt(a * a + 4.0 * b * budget) - a) / (2.0 * b);
  return std::clamp(scale, 0.0, 1.0) * force;
}

}  // namespace filum
