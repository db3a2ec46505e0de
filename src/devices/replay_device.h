#pragma once
// Plays samples that were recorded before: each comes when the scene's clock reaches the time it once
// arrived.

#include <string>
#include <vector>

#include "devices/device.h"

namespace filum {

class ReplayDevice final : public Device {
 public:
  /// `samples` in any order, host_time_us in the time of the scene [us]. Impossible ones are left out and
  /// counted as rejected.
  ReplayDevice(std::string name, std::vector<DeviceSample> samples);

  const std::string& name() const override { return name_; }
  /// When more are due than one call may give, the rest follows with the next call.
  void poll(std::int64_t now_us, std::vector<DeviceSample>& out) noexcept override;
  DeviceHealth health() const noexcept override { return health_; }
  std::int64_t duration_us() const noexcept { return samples_.empty() ? 0 : samples_.back().host_time_us; }

 private:
  std::string name_;
  std::vector<DeviceSample> samples_;
  std::size_t next_ = 0;
  DeviceHealth health_;
};

}  // namespace filum
