#include "devices/serial_forceps.h"

#include <array>
#include <utility>

namespace filum {
namespace {

constexpr std::int64_t kStaleAfter = 100'000;   // [us] without a good frame
constexpr std::int64_t kPingEvery = 1'000'000;  // [us]
constexpr std::size_t kBytesPerPoll = 4096;  // at 20 bytes for the shortest sample, below kMaxSamplesPerPoll
static_assert(kBytesPerPoll / 20 < kMaxSamplesPerPoll);

}  // namespace

SerialForceps::SerialForceps(const std::string& port, ForcepsCalibration calibration, int baud)
    : name_("serial " + port), stream_(std::move(calibration)), port_(port, baud) {}

void SerialForceps::poll(std::int64_t now_us, std::vector<DeviceSample>& out) noexcept {
  std::array<std::uint8_t, kBytesPerPoll> bytes;
  std::size_t n = 0;
  switch (port_.read(bytes, n)) {
    case SerialPort::Read::data:
      stream_.feed(std::span(bytes).first(n), now_us, out);
      break;
    case SerialPort::Read::gone:
      state_ = DeviceState::lost;
      return;
    case SerialPort::Read::back:
      stream_.restart();
      return;
    case SerialPort::Read::nothing:
      break;
  }
  if (!port_.open()) return;
  ping(now_us);
  const auto last = stream_.last_frame_us();
  if (!last) return;  // nothing was ever heard: waiting
  if (now_us - *last <= kStaleAfter)
    state_ = DeviceState::live;
  else if (state_ != DeviceState::lost)
    state_ = DeviceState::stale;
}

void SerialForceps::ping(std::int64_t now_us) noexcept {
  if (now_us < next_ping_us_) return;
  next_ping_us_ = now_us + kPingEvery;
  filum_frame frame{};
  const filum_ping ping{static_cast<std::uint32_t>(now_us)};
  filum_put_ping(&frame, &ping);
  frame.sequence = ping_sequence_++;
  frame.time_us = ping.host_us;
  std::array<std::uint8_t, FILUM_MAX_WIRE> wire;
  // Half a ping when the line is full is refused by the handle like any damaged frame.
  port_.write(std::span(wire).first(filum_frame_encode(&frame, wire.data())));
}

DeviceHealth SerialForceps::health() const noexcept {
  return {state_, stream_.received(), stream_.lost(), stream_.frames().corrupt(), stream_.rejected()};
}

}  // namespace filum
