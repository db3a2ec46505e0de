#pragma once
// Leads through the calibration of one channel: which value to set next, when the reading is steady enough, and what was
// read. Owns no port and asks nobody: whoever shows it (a terminal, a page) passes samples in and says when the value is set.

#include <cstdint>
#include <string>
#include <vector>

#include "devices/calibration_fit.h"
#include "devices/device.h"

namespace filum {

class CalibrationGuide {
 public:
  enum class Channel { angle, force };
  /// Goes through `levels` [rad] or [N], growing, upwards then downwards, `repeats` times.
  CalibrationGuide(Channel channel, std::vector<double> levels, int repeats);

  bool done() const { return at_ == plan_.size(); }
  /// "Open to 10 deg (coming from below)"; empty when done.
  std::string instruction() const;
  double value() const { return plan_[at_].value; }

  /// The value asked for is set: begin to read.
  void begin();
  bool reading() const { return reading_; }
  /// A sample of the handle; ends the reading after kSamples of them. One that was not steady is not taken: the value is asked for again.
  void take(const DeviceSample& sample);
  /// Reading could not be used (broken wire, silence): ask for the same value again.
  void again() { reading_ = false; }
  /// Takes the last value back, so that it is asked for again; first of all a reading under way.
  void undo();
  /// [count], spread of the last reading if it was not steady, else 0.
  double unsteady() const { return unsteady_; }
  /// Of the samples that a reading takes, 0 to 1.
  double progress() const { return static_cast<double>(counts_.size()) / static_cast<double>(kSamples); }

  const std::vector<CalibrationPoint>& points() const { return points_; }

  static constexpr std::size_t kSamples = 500;  // half a second

 private:
  Channel channel_;
  std::vector<CalibrationPoint> plan_;  // count and noise not yet known
  std::size_t at_ = 0;
  bool reading_ = false;
  double unsteady_ = 0.0;               // [count]
  std::vector<double> counts_;
  std::vector<CalibrationPoint> points_;
};

}  // namespace filum
