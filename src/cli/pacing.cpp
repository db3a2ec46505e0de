#include "cli/pacing.h"

#include <algorithm>

namespace filum {

std::int64_t Pacing::due(std::int64_t now_us) noexcept {
  const std::int64_t due = next_us_ < 0 ? now_us : std::max(next_us_, now_us);
  next_us_ = due + dt_us_;
  return due;
}

bool Pacing::ended(std::int64_t begin_us, std::int64_t end_us) noexcept {
  const auto dt = static_cast<double>(dt_us_);
  if (last_begin_us_ >= 0) {
    const double weight = std::min(1.0, dt / 0.5e6);  // half a second
    period_us_ += weight * (static_cast<double>(begin_us - last_begin_us_) - period_us_);
    factor_ = period_us_ > 0.0 ? dt / period_us_ : 1.0;
  } else {
    period_us_ = dt;
  }
  last_begin_us_ = begin_us;
  const bool late = end_us - begin_us > dt_us_;
  overruns_ += late;
  return late;
}

}  // namespace filum
