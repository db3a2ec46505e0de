#include "devices/calibration_guide.h"

#include <cmath>
#include <cstdio>
#include <numbers>

namespace filum {

CalibrationGuide::CalibrationGuide(Channel channel, std::vector<double> levels, int repeats) : channel_(channel) {
  for (int repeat = 0; repeat < repeats; ++repeat) {
    for (double level : levels) plan_.push_back({level, 0.0, 0.0, true});
    for (auto level = levels.rbegin(); level != levels.rend(); ++level) plan_.push_back({*level, 0.0, 0.0, false});
  }
}

std::string CalibrationGuide::instruction() const {
  if (done()) return {};
  const CalibrationPoint& next = plan_[at_];
  char text[120];
  if (channel_ == Channel::angle) {
    std::snprintf(text, sizeof text, "Set the opening to %.4g deg, coming from %s", next.value * 180.0 / std::numbers::pi,
                  next.upwards ? "a smaller one" : "a larger one");
  } else {
    std::snprintf(text, sizeof text, "Load the pad with %.4g N (%.4g g), coming from %s", next.value, next.value / 9.80665e-3,
                  next.upwards ? "less" : "more");
  }
  return text;
}

void CalibrationGuide::begin() {
  reading_ = !done();
  unsteady_ = 0.0;
  counts_.clear();
}

void CalibrationGuide::undo() {
  if (!reading_ && at_ > 0) {
    --at_;
    points_.pop_back();
  }
  reading_ = false;
  unsteady_ = 0.0;
  counts_.clear();
}

void CalibrationGuide::take(const DeviceSample& sample) {
  if (!reading_) return;
  const bool angle = channel_ == Channel::angle;
  if (angle ? !sample.has_grip_angle : !sample.has_grip_force) return;
  counts_.push_back(angle ? sample.raw_angle : sample.raw_force);
  if (counts_.size() < kSamples) return;
  double mean = 0.0, square = 0.0;
  for (double count : counts_) mean += count / static_cast<double>(counts_.size());
  for (double count : counts_) square += (count - mean) * (count - mean);
  CalibrationPoint point = plan_[at_];
  point.count = mean;
  point.noise = std::sqrt(square / static_cast<double>(counts_.size() - 1));
  reading_ = false;
  counts_.clear();
  if (point.noise > CalibrationDemands{}.noise) {
    unsteady_ = point.noise;
    return;
  }
  points_.push_back(point);
  ++at_;
}

}  // namespace filum
