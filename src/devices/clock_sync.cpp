#include "devices/clock_sync.h"

#include <algorithm>

namespace filum {

std::int64_t WideClock::unwrap(std::uint32_t time_us) noexcept {
  if (!started_) {
    started_ = true;
    wide_ = time_us;
    return wide_;
  }
  const auto step = static_cast<std::int32_t>(time_us - static_cast<std::uint32_t>(wide_));
  wide_ += step;
  return wide_;
}

void ClockSync::pong(std::int64_t sent_us, std::int64_t device_us, std::int64_t back_us) noexcept {
  const std::int64_t trip = back_us - sent_us;
  if (trip < 0 || trip > 1'000'000) return;
  last_[n_ % last_.size()] = {device_us - (sent_us + trip / 2), trip};
  ++n_;
}

const ClockSync::Exchange& ClockSync::best() const noexcept {
  const auto end =
      last_.begin() + static_cast<std::ptrdiff_t>(std::max<std::size_t>(1, std::min(n_, last_.size())));
  return *std::min_element(last_.begin(), end,
                           [](const Exchange& a, const Exchange& b) { return a.trip < b.trip; });
}

}  // namespace filum
