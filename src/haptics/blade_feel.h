#pragma once
// The force of a blade that goes exactly where the hand goes, at 1 kHz between steps of the world. The world says, at its own
// rate, where the blade was (p_k), what the tissue pushed with (f_k) and how that grows as the blade goes on (K_k, the local
// stiffness of the nodes touched: LinearFem::respond). Until it speaks again
//   f(t) = f_k - K_k (p(t) - p_k),   none once it would pull,
// the first-order local model of Mark et al. (SIGGRAPH 1996) with a stiffness that is computed rather than guessed from the
// last two forces. A new step never makes the force jump: what the last prediction was wrong by fades out over the time that
// the world takes for a step. Damping of the tissue is in f_k.
// Symbols: p [m], f [N], K [N/m]. Neglects: torque from turning, damping within a step. Test: blade_feel_test.

#include <cstdint>

#include "base/pose.h"

namespace filum {

class BladeFeel {
 public:
  static constexpr double kStiffest = 3000.0;               // [N/m], of K, largest of an entry
  static constexpr std::int64_t kLongest = 20'000;          // [us], over which a jump fades at most

  /// What the world says at now_us [us]: blade at p_T, force f_T of the scene on it, local stiffness; the hand is at p_D now.
  void update(const Vec3& p_T, const Vec3& f_T, const Mat3& stiffness, const Vec3& p_D, std::int64_t now_us) noexcept;
  /// Force on the hand at p_D. [N]
  Vec3 force(const Vec3& p_D, std::int64_t now_us) const noexcept;
  void release() noexcept { known_ = false; }
  bool known() const noexcept { return known_; }

 private:
  Vec3 predicted(const Vec3& p_D) const noexcept;

  bool known_ = false;
  Vec3 p_ = Vec3::Zero(), f_ = Vec3::Zero(), jump_ = Vec3::Zero();
  Mat3 stiffness_ = Mat3::Zero();
  std::int64_t time_us_ = 0, fade_us_ = 2000;
};

}  // namespace filum
