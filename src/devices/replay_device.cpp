#include "devices/replay_device.h"

#include <algorithm>
#include <utility>

#include "devices/sample_check.h"

namespace filum {

ReplayDevice::ReplayDevice(std::string name, std::vector<DeviceSample> samples)
    : name_(std::move(name)), samples_(std::move(samples)) {
  health_.rejected =
      std::erase_if(samples_, [](const DeviceSample& s) { return fault_of(s) != SampleFault::none; });
  std::stable_sort(samples_.begin(), samples_.end(), [](const DeviceSample& a, const DeviceSample& b) {
    return a.host_time_us < b.host_time_us;
  });
}

void ReplayDevice::poll(std::int64_t now_us, std::vector<DeviceSample>& out) noexcept {
  for (std::size_t n = 0; n < kMaxSamplesPerPoll && next_ < samples_.size(); ++n, ++next_) {
    if (samples_[next_].host_time_us > now_us) break;
    out.push_back(samples_[next_]);
    ++health_.received;
    health_.state = DeviceState::live;
  }
  if (next_ < samples_.size()) {
    // A gap in the recording is a gap again.
    const bool gap = next_ > 0 && now_us - samples_[next_ - 1].host_time_us > stale_after_us();
    if (health_.state != DeviceState::waiting) health_.state = gap ? DeviceState::stale : DeviceState::live;
    return;
  }
  if (now_us > duration_us()) health_.state = DeviceState::finished;
}

}  // namespace filum
