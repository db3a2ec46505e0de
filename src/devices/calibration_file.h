#pragma once
// Calibration readings from a file (format filum-calibration-points/1) and the calibration file that comes of them
// (filum-forceps/1): identity, date, sensor, fits, residuals of each reading, range of validity.

#include <string>
#include <vector>

#include "devices/calibration_fit.h"

namespace filum {

struct CalibrationReadings {
  std::vector<CalibrationPoint> angle;  // [rad]
  std::vector<CalibrationPoint> force;  // [N]
};

/// Throws InputError.
CalibrationReadings load_readings(const std::string& path);
CalibrationReadings parse_readings(const std::string& text, const std::string& file_name);

struct CalibrationHeader {
  std::string name, sensor, date;  // date "2026-11-21"
  unsigned identity = 0;
  double angle_limit = 0.61;       // [rad]
  double force_limit = 5.0;        // [N]
};

/// Text of the calibration file; both fits are good.
std::string calibration_text(const CalibrationHeader& header, const CalibrationReadings& readings, const CalibrationFit& angle,
                             const CalibrationFit& force);

}  // namespace filum
