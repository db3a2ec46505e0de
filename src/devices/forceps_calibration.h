#pragma once
// From raw counts to opening angle and squeeze, by a calibration file in models/forceps/ (format
// filum-forceps/1).

#include <cstdint>
#include <optional>
#include <string>

#include "devices/bridge_line.h"

namespace filum {

/// What a fit said of one channel; absent in a nominal file.
struct ChannelEvidence {
  double residual = 0.0, hysteresis = 0.0, repeatability = 0.0;  // [rad] or [N], see calibration_fit.h
  double from = 0.0, to = 0.0;                                   // [rad] or [N], range of validity
};

struct ForcepsCalibration {
  std::string name;
  std::string source;
  std::uint32_t identity = 0;      // as the handle says in its hello, 0 = not tied to one handle
  double angle_zero = 0.0;         // [count] with the jaws just closed
  double angle_gain = 0.0;         // [rad/count]
  double angle_uncertainty = 0.0;  // [rad], one standard deviation
  double force_zero = 0.0;         // [count] without load
  double force_gain = 0.0;         // [N/count]
  double force_uncertainty = 0.0;  // [N], one standard deviation
  std::string date, sensor;        // when, and serial number of the handle; empty in a nominal file
  std::optional<ChannelEvidence> angle_evidence, force_evidence;
  double angle_limit = 0.0;        // [rad], mechanical stop
  double force_limit = 0.0;        // [N], above this the sensor is overloaded

  /// Throws InputError.
  static ForcepsCalibration load(const std::string& path);
  static ForcepsCalibration parse(const std::string& text, const std::string& file_name);

  BridgeLine angle_line() const noexcept { return {angle_zero, angle_gain}; }
  BridgeLine force_line() const noexcept { return {force_zero, force_gain}; }
  /// [rad], at most the stop; below zero the blades are bent beyond closure, at most as far.
  double angle(std::uint16_t count) const noexcept;
  /// [N], between 0 and the overload limit.
  double force(std::uint16_t count) const noexcept;
  /// The count that comes nearest to a value; used to play scripts through the wire.
  std::uint16_t angle_count(double angle) const noexcept;
  std::uint16_t force_count(double force) const noexcept;
};

}  // namespace filum
