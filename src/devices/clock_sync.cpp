#include "devices/clock_sync.h"

#include <algorithm>
#include <cmath>

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

void ClockDrift::pong(std::int64_t sent_us, std::int64_t device_us, std::int64_t back_us) noexcept {
  const std::int64_t trip = back_us - sent_us, middle = sent_us + trip / 2;
  if (trip < 0 || trip > 1'000'000) return;
  if (in_point_ == 0 || trip < best_.trip) best_ = {middle, device_us - middle, trip};
  if (++in_point_ < kPerPoint) return;
  in_point_ = 0;
  points_[n_++ % kPoints] = best_;
}

ClockDrift::Line ClockDrift::at(std::int64_t host_us) const noexcept {
  Line line;
  const std::size_t n = std::min(n_, kPoints);
  if (n == 0) return line;
  const Point origin = points_[0];  // differences from one point keep all digits
  double t = 0.0, y = 0.0;
  for (std::size_t k = 0; k < n; ++k) {
    t += static_cast<double>(points_[k].host - origin.host) / static_cast<double>(n);
    y += static_cast<double>(points_[k].offset - origin.offset) / static_cast<double>(n);
  }
  double tt = 0.0, ty = 0.0, residual = 0.0;
  for (std::size_t k = 0; k < n; ++k) {
    const double dt = static_cast<double>(points_[k].host - origin.host) - t;
    tt += dt * dt;
    ty += dt * (static_cast<double>(points_[k].offset - origin.offset) - y);
  }
  const double slope = tt > 0.0 ? ty / tt : 0.0;
  for (std::size_t k = 0; k < n; ++k) {
    const double dt = static_cast<double>(points_[k].host - origin.host) - t;
    const double r = static_cast<double>(points_[k].offset - origin.offset) - y - slope * dt;
    residual += r * r;
  }
  line.drift_ppm = 1e6 * slope;
  if (n > 2 && tt > 0.0) line.drift_uncertainty_ppm = 1e6 * std::sqrt(residual / (static_cast<double>(n) - 2.0) / tt);
  line.offset_us = static_cast<double>(origin.offset) + y + slope * (static_cast<double>(host_us - origin.host) - t);
  return line;
}

}  // namespace filum
