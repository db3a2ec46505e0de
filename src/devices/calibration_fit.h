#pragma once
// A straight line from counts to angle or force, from readings at known values taken upwards and downwards several times,
// with what an uncertainty needs (JCGM 100:2008, GUM): residuals, hysteresis, repeatability.
//
//   value = gain (count - zero), least squares of the values over the counts.
//   residual       standard deviation about the line, n - 2 degrees of freedom
//   hysteresis     largest difference of the upward and downward means at one value, in the value's unit
//   repeatability  pooled standard deviation of readings at the same value and direction, in the value's unit
//   uncertainty    one standard deviation of a single later reading: sqrt(residual^2 + (hysteresis / sqrt 12)^2 +
//                  repeatability^2 + (gain * noise)^2), hysteresis taken as evenly distributed.
// Refuses where the data do not support a line. Neglects: the uncertainty of the reference itself, drift with time and
// temperature. Test: calibration_fit_test.

#include <string>
#include <vector>

namespace filum {

struct CalibrationPoint {
  double value = 0.0;   // [rad] or [N], the reference
  double count = 0.0;   // [count], mean of the readings
  double noise = 0.0;   // [count], their standard deviation
  bool upwards = true;  // approached from below
};

struct CalibrationFit {
  bool good = false;
  std::string why;                 // where refused
  double gain = 0.0;               // [value/count]
  double zero = 0.0;               // [count]
  double uncertainty = 0.0;        // of a later reading, one standard deviation
  double residual = 0.0, hysteresis = 0.0, repeatability = 0.0;
  double from = 0.0, to = 0.0;     // values it was taken between
  double count_from = 0.0, count_to = 0.0;  // [count]
  std::vector<double> residuals;   // of each point
};

struct CalibrationDemands {
  int levels = 5;             // different values, at least
  int repeats = 2;            // readings at each value in each direction, at least
  double counts = 200.0;      // span of counts, at least
  double noise = 20.0;        // [count], standard deviation of a steady reading, at most
  double residual = 0.05;     // of the span, at most: otherwise it is no line
  double hysteresis = 0.10;   // of the span, at most
  double repeatability = 0.05;
  double count_low = 205.0, count_high = 3887.0;  // outside, the amplifier is saturated
};

/// `unit` names the value in reasons, e.g. "deg" with scale pi/180.
CalibrationFit fit_line(const std::vector<CalibrationPoint>& points, const CalibrationDemands& demands, const std::string& unit,
                        double scale);

}  // namespace filum
