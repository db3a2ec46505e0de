#pragma once
// What a sensorised handle says of its own readings while a session runs: a broken wire, an amplifier at the end of its range, a
// calibration that is another handle's. Each fault is one event when it begins, and a warning until it has been gone for a second.
// Test: tests/cli/handle_watch_test.cpp.

#include <array>
#include <vector>

#include "devices/device.h"
#include "training/task_session.h"

namespace filum {

class HandleWatch {
 public:
  /// One sample, at scene time `time` [s].
  void take(const DeviceSample& sample, double time);
  /// Events since the start, in order.
  const std::vector<TaskEvent>& events() const { return events_; }
  /// In force at scene time `time` [s].
  std::vector<TaskWarning> warnings(double time) const;

  static constexpr std::size_t kFaults = 6;
  static constexpr double kGone = 1.0;  // [s]

 private:
  std::array<std::array<double, kFaults>, kMaxTools> last_ = never();  // [s], when each was last said of each tool
  std::vector<TaskEvent> events_;
  static std::array<std::array<double, kFaults>, kMaxTools> never();
};

}  // namespace filum
