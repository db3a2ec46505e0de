#pragma once
// The force a hand should feel from one tool: a spring and damper between the commanded pose and the
// simulated tool (virtual coupling: J. E. Colgate, M. C. Stanley, J. M. Brown, IROS 1995), with the force and
// its rate of change limited, and an energy tank that makes it passive whatever delays lie between (M.
// Franken et al., IEEE Trans. Robotics 27 (2011) 741-756).
//
//   f = k (p_T - p_D) + b (v_T - v_D),   |f| <= f_max,   |df/dt| <= s
//   tank: E += -f_prev . (p_D - p_D_prev), at most E_max; the sample-and-hold force makes this exact
//   (J.-H. Ryu, Y. S. Kim, B. Hannaford, IEEE Trans. Robotics 20 (2004) 365-373)
//   the next force may not spend more than E on the way the hand is about to go: v dt, and f dt^2 / (2 m) for
//   the hand it pushes.
// Neglects: torque; the tool's motion between two states of the world is taken as uniform. Test:
// hand_coupling_test.

#include <cstdint>

#include "base/pose.h"

namespace filum {

struct HandCouplingOptions {
  double stiffness =
      500.0;  // [N/m], that of the instruments' own coupling, so that the force is the scene's in newtons
  double damping = 0.5;            // [N s/m]
  double force_limit = 3.3;        // [N], peak of common desktop haptic devices
  double slew_limit = 200.0;       // [N/s]
  double lightest_hand = 0.05;     // [kg], apparent mass of hand and handle at the tip
  double tank_start = 2e-4;        // [J], what may be spent before anything was taken in
  double tank_size = 2e-2;         // [J]
  double velocity_cutoff = 600.0;  // [1/s], of the first-order filter on the velocity of the hand
};

class HandCoupling {
 public:
  explicit HandCoupling(const HandCouplingOptions& options = {})
      : options_(options), tank_(options.tank_start) {}

  /// Force on the hand [N], frame W. p_D: commanded tip [m]; p_T, v_T: simulated tip [m], [m/s]; dt [s] since
  /// the last call.
  Vec3 force(const Vec3& p_D, const Vec3& p_T, const Vec3& v_T, double dt) noexcept;
  /// The same limits and tank for a force that is known: that of a blade which goes where the hand goes (haptics/blade_feel.h).
  Vec3 pass(const Vec3& wanted, const Vec3& p_D, double dt) noexcept;
  /// No force, at once, and the next call starts afresh: the device or the pose is not to be trusted.
  void release() noexcept;

  double tank() const noexcept { return tank_; }  // [J]
  std::uint64_t held_back() const noexcept {
    return held_back_;
  }  // times the tank was too empty for the force

 private:
  Vec3 moved_to(const Vec3& p_D, double dt) noexcept;
  Vec3 limited(const Vec3& wanted, double dt) const noexcept;
  Vec3 affordable(const Vec3& force, const Vec3& moved, double dt) noexcept;

  HandCouplingOptions options_;
  double tank_;  // [J]
  std::uint64_t held_back_ = 0;
  bool started_ = false;
  Vec3 p_D_ = Vec3::Zero();    // [m], of the last call
  Vec3 v_D_ = Vec3::Zero();    // [m/s], filtered
  Vec3 force_ = Vec3::Zero();  // [N], given since the last call
};

}  // namespace filum
