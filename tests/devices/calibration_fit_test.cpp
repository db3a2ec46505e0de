#include "devices/calibration_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace filum {
namespace calibration_fit_test {

struct Sensor {
  double gain = 2e-4, zero = 700.0;  // [rad/count], [count]
  double hysteresis = 0.0;           // [rad], upward readings lower by half, downward higher by half, in the middle
  double noise = 0.0;                // [count], between repeats
  double bend = 0.0;                 // [rad], quadratic
};

std::vector<CalibrationPoint> readings(const Sensor& s, int levels = 6, int repeats = 3, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0.0, s.noise > 0.0 ? s.noise : 1.0);
  std::vector<CalibrationPoint> points;
  for (int r = 0; r < repeats; ++r)
    for (const bool up : {true, false})
      for (int k = 0; k < levels; ++k) {
        const double value = 0.5 * k / (levels - 1), share = value / 0.5;
        const double seen = value + (up ? -0.5 : 0.5) * s.hysteresis * 4.0 * share * (1.0 - share) + s.bend * share * share;
        points.push_back({value, s.zero + seen / s.gain + (s.noise > 0.0 ? normal(random) : 0.0), 1.0, up});
      }
  return points;
}

CalibrationFit fitted(const Sensor& s) { return fit_line(readings(s), {}, "rad", 1.0); }

TEST(CalibrationFit, FindsALineExactly) {
  const CalibrationFit f = fitted({});
  ASSERT_TRUE(f.good) << f.why;
  EXPECT_NEAR(f.gain, 2e-4, 1e-15);
  EXPECT_NEAR(f.zero, 700.0, 1e-8);
  EXPECT_NEAR(f.residual, 0.0, 1e-12);
  EXPECT_NEAR(f.uncertainty, 2e-4, 1e-9) << "what is left is the reading's own noise of one count";
  EXPECT_EQ(f.from, 0.0);
  EXPECT_EQ(f.to, 0.5);
}

TEST(CalibrationFit, HysteresisAndRepeatabilityAreToldApart) {
  Sensor s;
  s.hysteresis = 0.02;
  CalibrationFit f = fitted(s);
  EXPECT_NEAR(f.hysteresis, 0.02 * 0.96, 1e-4) << "the level nearest the middle is at 0.4";
  EXPECT_NEAR(f.repeatability, 0.0, 1e-12);
  s.hysteresis = 0.0;
  s.noise = 20.0;
  f = fit_line(readings(s, 6, 12), {}, "rad", 1.0);
  EXPECT_NEAR(f.repeatability, 20.0 * 2e-4, 0.15 * 20.0 * 2e-4);
  EXPECT_LT(f.hysteresis, 0.01);
}

TEST(CalibrationFit, UncertaintyCoversLaterReadings) {
  Sensor s;
  s.noise = 10.0;
  s.hysteresis = 0.01;
  const CalibrationFit f = fitted(s);
  ASSERT_TRUE(f.good) << f.why;
  int inside = 0, n = 0;
  for (const CalibrationPoint& p : readings(s, 21, 10, 99)) {
    inside += std::abs(p.value - f.gain * (p.count - f.zero)) < 2.0 * f.uncertainty ? 1 : 0;
    ++n;
  }
  EXPECT_GT(inside, 0.93 * n);
}

void expect_refusal(const CalibrationFit& f, const std::string& word) {
  EXPECT_FALSE(f.good);
  EXPECT_NE(f.why.find(word), std::string::npos) << f.why;
}

TEST(CalibrationFit, RefusesWithTheReason) {
  expect_refusal(fit_line(readings({}, 4), {}, "rad", 1.0), "at least 5");
  expect_refusal(fit_line(readings({}, 6, 1), {}, "rad", 1.0), "at least 2 are needed");
  auto points = readings({});
  std::erase_if(points, [](const CalibrationPoint& p) { return !p.upwards && p.value > 0.4; });
  expect_refusal(fit_line(points, {}, "rad", 1.0), "no reading downwards");
  points = readings({});
  points[3].count = 4000.0;
  expect_refusal(fit_line(points, {}, "rad", 1.0), "saturated");
  points = readings({});
  points[3].noise = 40.0;
  expect_refusal(fit_line(points, {}, "rad", 1.0), "not steady");
  Sensor s;
  s.gain = 1.0;
  expect_refusal(fitted(s), "check gain and wiring");
  s = {};
  s.hysteresis = 0.1;
  expect_refusal(fitted(s), "hysteresis");
  s = {};
  s.gain = 8e-4;
  s.bend = 1.0;
  expect_refusal(fitted(s), "not on a line");
  s = {};
  s.gain = 4e-4;
  s.noise = 150.0;
  expect_refusal(fitted(s), "do not repeat");
  expect_refusal(fit_line({}, {}, "rad", 1.0), "at 0 values");
}

}  // namespace calibration_fit_test
}  // namespace filum
