#pragma once
// Device clocks: a 32-bit microsecond counter made 64 bits wide, and its offset from the host's clock by ping
// and pong.

#include <array>
#include <cstddef>
#include <cstdint>

namespace filum {

/// Unwraps a 32-bit microsecond clock (71.6 min). Steps of less than half a turn either way are followed
/// exactly.
class WideClock {
 public:
  std::int64_t unwrap(std::uint32_t time_us) noexcept;
  void restart() noexcept { started_ = false; }

 private:
  bool started_ = false;
  std::int64_t wide_ = 0;  // [us]
};

/// Offset of a device's clock from the host's, from the exchange with the shortest round trip among the
/// last 16. Error is at most half that round trip (D. L. Mills, IEEE Trans. Commun. 39 (1991) 1482-1493).
class ClockSync {
 public:
  /// All in microseconds: host clock when the ping left, device clock when it arrived, host clock when the
  /// pong was back. Answers from the future or older than 1 s are ignored.
  void pong(std::int64_t sent_us, std::int64_t device_us, std::int64_t back_us) noexcept;
  void restart() noexcept { n_ = 0; }

  bool known() const noexcept { return n_ > 0; }
  std::int64_t offset_us() const noexcept { return best().offset; }             // [us], device minus host
  std::int64_t uncertainty_us() const noexcept { return best().trip / 2 + 1; }  // [us]

 private:
  struct Exchange {
    std::int64_t offset = 0, trip = 0;  // [us]
  };
  const Exchange& best() const noexcept;

  std::array<Exchange, 16> last_{};
  std::size_t n_ = 0;
};

/// Rate of a device's clock against the host's: the exchange with the shortest round trip of every kPerPoint gives one
/// offset; a least-squares line through the newest kPoints of them gives offset and drift. The uncertainty is that of the
/// line's slope from its residuals (one standard deviation); a constant asymmetry of the line's two ways shifts the offset
/// and leaves the drift alone.
class ClockDrift {
 public:
  void pong(std::int64_t sent_us, std::int64_t device_us, std::int64_t back_us) noexcept;
  void restart() noexcept { n_ = in_point_ = 0; }

  bool known() const noexcept { return n_ >= 3; }
  struct Line {
    double offset_us = 0.0;           // [us], device minus host, at `host_us`
    double drift_ppm = 0.0;           // [1e-6], device faster than the host
    double drift_uncertainty_ppm = 0.0;
  };
  Line at(std::int64_t host_us) const noexcept;

 private:
  static constexpr std::size_t kPoints = 64, kPerPoint = 4;
  struct Point {
    std::int64_t host = 0, offset = 0, trip = 0;  // [us]
  };
  std::array<Point, kPoints> points_{};
  std::size_t n_ = 0, in_point_ = 0;
  Point best_;
};

}  // namespace filum
