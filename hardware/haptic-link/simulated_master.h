#pragma once
// A haptic device with a hand on it, for those who have none: a mass with friction, held by a hand's stiffness and damping
// (impedance of fingers: 50-2000 N/m), integrated at 20 kHz; encoders with steps; the guard of filum_link.h before the
// motors. Used by the reference client and the tests.
//
//   m a = f + K (target - x) - B v - F_c v / |v|

#include <cmath>

#include "base/pose.h"
#include "hardware/haptic-link/filum_link.h"

namespace filum {

struct MasterParameters {
  double mass = 0.1;            // [kg], device and hand, apparent at the tip
  double friction = 0.05;       // [N], Coulomb
  double hand_stiffness = 500;  // [N/m]
  double hand_damping = 2.0;    // [N s/m]
  double encoder = 0.0;         // [m], step; 55 um for a Touch, 0 for none
  double force_limit = 3.3;     // [N]
};

class SimulatedMaster {
 public:
  explicit SimulatedMaster(const MasterParameters& p) : p_(p) { filum_guard_init(&guard_, p.force_limit); }

  /// One period of the motors: `wanted` [N] is the newest force, `fresh` if it came in this period.
  void step(const Vec3& target, const Vec3& wanted, bool fresh, double dt) {
    const Vec3 seen = measured();
    filum_guard_step(&guard_, seen.data(), wanted.data(), fresh, dt, force_.data());
    constexpr int kSub = 20;
    const double h = dt / kSub;
    for (int k = 0; k < kSub; ++k) {
      const Vec3 push = force_ + p_.hand_stiffness * (target - x_) - p_.hand_damping * v_;
      v_ += h / p_.mass * push;
      const double speed = v_.norm(), stop = h * p_.friction / p_.mass;
      v_ *= speed > stop ? 1.0 - stop / speed : 0.0;
      x_ += h * v_;
      given_ += h * force_.dot(v_);
    }
  }

  Vec3 measured() const {
    if (p_.encoder <= 0.0) return x_;
    return (x_ / p_.encoder).array().round().matrix() * p_.encoder;
  }
  const Vec3& position() const { return x_; }
  const Vec3& velocity() const { return v_; }
  const Vec3& force() const { return force_; }  // [N], given by the motors
  double given() const { return given_; }       // [J], by the motors to the hand so far
  const filum_guard& guard() const { return guard_; }

 private:
  MasterParameters p_;
  filum_guard guard_{};
  Vec3 x_ = Vec3::Zero(), v_ = Vec3::Zero(), force_ = Vec3::Zero();
  double given_ = 0.0;
};

}  // namespace filum
