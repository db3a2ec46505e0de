#pragma once
// A made-up tremor for scripted hands: tones of equal power about a centre frequency, at the quantiles of a Lorentzian
// line, along fixed directions of their own. The root mean square of the displacement over long times is `rms`. It lets a
// demonstration be analysed like a hand whose tremor is known. Test: hand_tremor_test.

#include <array>
#include <cstddef>

#include "base/pose.h"

namespace filum {

class HandTremor {
 public:
  /// rms [m], of the displacement in space; frequency [Hz]; width [Hz], full at half the power.
  HandTremor(double rms, double frequency, double width);
  /// Displacement at time t [s]. [m]
  Vec3 at(double t) const noexcept;

 private:
  static constexpr std::size_t kTones = 24;
  struct Tone {
    Vec3 amplitude = Vec3::Zero();  // [m]
    double frequency = 0.0;         // [Hz]
    double phase = 0.0;             // [rad]
  };
  std::array<Tone, kTones> tones_;
};

}  // namespace filum
