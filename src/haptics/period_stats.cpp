#include "haptics/period_stats.h"

#include <algorithm>

namespace filum {

void PeriodStats::add(std::int64_t period_us) noexcept {
  const std::int64_t period = std::max<std::int64_t>(period_us, 0);
  const auto bucket = std::min<std::size_t>(static_cast<std::size_t>(period / kBucket), buckets_.size() - 1);
  ++buckets_[bucket];
  ++count_;
  longest_us_ = std::max(longest_us_, period);
}

std::int64_t PeriodStats::quantile(double fraction) const noexcept {
  if (count_ == 0) return 0;
  const double target = std::clamp(fraction, 0.0, 1.0) * static_cast<double>(count_);
  std::uint64_t below = 0;
  for (std::size_t i = 0; i + 1 < buckets_.size(); ++i) {
    below += buckets_[i];
    if (static_cast<double>(below) >= target)
      return std::min(static_cast<std::int64_t>(i + 1) * kBucket, longest_us_);
  }
  return longest_us_;
}

}  // namespace filum
