#include "devices/calibration_file.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "devices/forceps_calibration.h"

namespace filum {
namespace calibration_file_test {

CalibrationReadings readings() {
  CalibrationReadings r;
  for (int repeat = 0; repeat < 2; ++repeat)
    for (const bool up : {true, false})
      for (int k = 0; k < 6; ++k) {
        r.angle.push_back({0.08 * k, 500.0 + 500.0 * k + repeat, 1.0, up});
        r.force.push_back({0.5 * k, 400.0 + 600.0 * k + (up ? 2 : -2), 1.5, up});
      }
  return r;
}

TEST(CalibrationFile, WhatIsWrittenIsReadAndConverts) {
  const CalibrationReadings r = readings();
  const CalibrationFit angle = fit_line(r.angle, {}, "rad", 1.0), force = fit_line(r.force, {}, "N", 1.0);
  ASSERT_TRUE(angle.good) << angle.why;
  ASSERT_TRUE(force.good) << force.why;
  const std::string text = calibration_text({"left \"one\"", "SN-12", "2026-11-21", 42, 0.5, 3.0}, r, angle, force);
  const ForcepsCalibration c = ForcepsCalibration::parse(text, "c.yaml");
  EXPECT_EQ(c.name, "left one");
  EXPECT_EQ(c.sensor, "SN-12");
  EXPECT_EQ(c.date, "2026-11-21");
  EXPECT_EQ(c.identity, 42u);
  EXPECT_NEAR(c.angle(1500), 0.16, 1e-3);
  EXPECT_NEAR(c.force(1600), 1.0, 5e-3);
  ASSERT_TRUE(c.angle_evidence.has_value());
  EXPECT_NEAR(c.force_evidence->to, 2.5, 1e-9);
  EXPECT_NEAR(c.force_evidence->hysteresis, 4.0 * force.gain, 1e-9);
}

TEST(CalibrationFile, ReadingsAreReadAndNonsenseIsRefused) {
  const std::string good =
      "format: filum-calibration-points/1\nangle:\n  - { value: 5 deg, count: 1000 count, noise: 1 count, approached: upwards }\n"
      "force:\n  - { value: 0.2 N, count: 600 count, approached: downwards }\n";
  const CalibrationReadings r = parse_readings(good, "p.yaml");
  ASSERT_EQ(r.angle.size(), 1u);
  EXPECT_NEAR(r.angle[0].value, 0.0872665, 1e-6);
  EXPECT_FALSE(r.force[0].upwards);
  for (const char* bad : {"1000 count", "upwards", "5 deg"}) {
    std::string text = good;
    text.replace(text.find(bad), std::string(bad).size(), "nonsense");
    EXPECT_THROW(parse_readings(text, "p.yaml"), InputError) << bad;
  }
}

}  // namespace calibration_file_test
}  // namespace filum
