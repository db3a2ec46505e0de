#include "devices/pointer_device.h"

#include <utility>

namespace filum {
namespace {

constexpr std::size_t kQueue = 1024;  // 3 tools at 60 Hz for more than 5 s

}  // namespace

PointerDevice::PointerDevice(std::string name) : name_(std::move(name)), queue_(kQueue) {}

SampleFault PointerDevice::push(DeviceSample sample) noexcept {
  const SampleFault fault = fault_of(sample);
  if (fault != SampleFault::none) {
    rejected_.fetch_add(1, std::memory_order_relaxed);
    return fault;
  }
  if (sample.has_pose) sample.X_WD.q.normalize();
  sample.sequence = next_sequence_++;
  queue_.push(sample);  // when full the gap in the numbers tells poll()
  return SampleFault::none;
}

void PointerDevice::poll(std::int64_t now_us, std::vector<DeviceSample>& out) noexcept {
  DeviceSample sample;
  const bool connected = connected_.load(std::memory_order_acquire);
  for (std::size_t n = 0; n < kMaxSamplesPerPoll && queue_.pop(sample); ++n) {
    health_.lost += sample.sequence - expected_;
    expected_ = sample.sequence + 1;
    if (!connected) continue;  // sent before the browser went: no longer true
    sample.host_time_us = now_us;
    out.push_back(sample);
    ++health_.received;
    last_us_ = now_us;
  }
  if (!connected)
    health_.state = health_.received > 0 ? DeviceState::lost : DeviceState::waiting;
  else if (health_.received == 0)
    health_.state = DeviceState::waiting;
  else
    health_.state = now_us - last_us_ <= stale_after_us() ? DeviceState::live : DeviceState::stale;
}

DeviceHealth PointerDevice::health() const noexcept {
  DeviceHealth health = health_;
  health.rejected = rejected_.load(std::memory_order_relaxed);
  return health;
}

}  // namespace filum
