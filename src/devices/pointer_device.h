#pragma once
// Mouse, keyboard and gamepad in the browser: another thread (the server's) pushes what the browser said, the
// haptic thread polls it. What is impossible is refused and counted; a browser that disconnects leaves the
// tools without input.

#include <array>
#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "base/exchange.h"
#include "devices/device.h"
#include "devices/sample_check.h"

namespace filum {

class PointerDevice final : public Device {
 public:
  explicit PointerDevice(std::string name = "pointer");

  // Called by one thread, the same for all three.
  /// Takes a reading with its device_time_us, or says why not. The number and the time of arrival are given
  /// here.
  SampleFault push(DeviceSample sample) noexcept;
  void connected() noexcept { connected_.store(true, std::memory_order_release); }
  void disconnected() noexcept { connected_.store(false, std::memory_order_release); }

  const std::string& name() const override { return name_; }
  void poll(std::int64_t now_us, std::vector<DeviceSample>& out) noexcept override;
  DeviceHealth health() const noexcept override;
  /// A hand that rests sends nothing: the browser repeats its pose a few times a second.
  std::int64_t stale_after_us() const noexcept override { return 1'000'000; }

 private:
  std::string name_;
  Queue<DeviceSample> queue_;
  std::atomic<bool> connected_{false};
  std::atomic<std::uint64_t> rejected_{0};
  std::uint32_t next_sequence_ = 0;  // of the pushing thread
  std::uint32_t expected_ = 0;       // of the polling thread, as all below
  std::int64_t last_us_ = 0;         // [us]
  DeviceHealth health_;
};

}  // namespace filum
