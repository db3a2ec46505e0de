#pragma once
// How regularly a loop runs: a histogram of the time between ticks, of fixed size, cheap enough for every
// tick.

#include <array>
#include <cstdint>

namespace filum {

class PeriodStats {
 public:
  void add(std::int64_t period_us) noexcept;
  /// [us], upper edge of the bucket below which `fraction` of the periods lie; 0 when there are none.
  std::int64_t quantile(double fraction) const noexcept;
  std::int64_t longest_us() const noexcept { return longest_us_; }
  std::uint64_t count() const noexcept { return count_; }

 private:
  static constexpr std::int64_t kBucket = 20;  // [us]
  std::array<std::uint64_t, 1001> buckets_{};  // up to 20 ms; the last one holds all that is longer
  std::uint64_t count_ = 0;
  std::int64_t longest_us_ = 0;
};

}  // namespace filum
