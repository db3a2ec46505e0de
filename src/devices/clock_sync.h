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

}  // namespace filum
