#include "devices/hand_tremor.h"

#include <cmath>
#include <numbers>

#include "base/rng.h"

namespace filum {

HandTremor::HandTremor(double rms, double frequency, double width) {
  Rng rng(9);
  const double each = rms * std::sqrt(2.0 / static_cast<double>(kTones));
  for (std::size_t k = 0; k < kTones; ++k) {
    const double quantile = (static_cast<double>(k) + 0.5) / static_cast<double>(kTones);
    tones_[k].frequency = frequency + 0.5 * width * std::tan(0.8 * std::numbers::pi * (quantile - 0.5));  // tails cut
    tones_[k].amplitude = each * rng.direction();
    tones_[k].phase = rng.uniform(0.0, 2.0 * std::numbers::pi);
  }
}

Vec3 HandTremor::at(double t) const noexcept {
  Vec3 sum = Vec3::Zero();
  for (const Tone& tone : tones_) sum += std::sin(2.0 * std::numbers::pi * tone.frequency * t + tone.phase) * tone.amplitude;
  return sum;
}

}  // namespace filum
