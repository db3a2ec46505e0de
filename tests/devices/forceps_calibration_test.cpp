#include "devices/forceps_calibration.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/error.h"

namespace filum {
namespace forceps_calibration_test {

const char* kGood = R"(
format: filum-forceps/1
name: bench pair
source: weights and protractor
identity: 42
angle: { zero: 200 count, gain: 0.01 deg/count, uncertainty: 0.2 deg, limit: 30 deg }
force: { zero: 100 count, gain: -2 mN/count, uncertainty: 5 mN, limit: 4 N }
)";

TEST(ForcepsCalibration, TheNominalFileSaysThatItIsNominal) {
  const auto c = ForcepsCalibration::load(std::string(FILUM_SOURCE_DIR) + "/models/forceps/default.yaml");
  EXPECT_NE(c.source.find("uncalibrated"), std::string::npos);
  EXPECT_EQ(c.identity, 0u);
  EXPECT_GT(c.angle_gain, 0.0);
  EXPECT_GT(c.angle_uncertainty, 0.0);
  EXPECT_GT(c.force_uncertainty, 0.0);
}

TEST(ForcepsCalibration, ConvertsAndKeepsToItsLimits) {
  const auto c = ForcepsCalibration::parse(kGood, "pair.yaml");
  const double degree = std::numbers::pi / 180;
  EXPECT_NEAR(c.angle(1200), 10 * degree, 1e-12);
  EXPECT_NEAR(c.angle(0), -2 * degree, 1e-12) << "bent beyond closure";
  EXPECT_NEAR(c.angle(65535), 30 * degree, 1e-12);
  EXPECT_NEAR(c.force(50), 0.1, 1e-12);
  EXPECT_EQ(c.force(4000), 0.0);
  EXPECT_EQ(c.identity, 42u);
}

TEST(ForcepsCalibration, CountsAndValuesAreInverse) {
  const auto c = ForcepsCalibration::parse(kGood, "pair.yaml");
  for (std::uint16_t count = 0; count < 3200; ++count) ASSERT_EQ(c.angle_count(c.angle(count)), count);
  for (std::uint16_t count = 0; count <= 100; ++count) ASSERT_EQ(c.force_count(c.force(count)), count);
  EXPECT_EQ(c.angle_count(-9.0), 0);
  EXPECT_EQ(c.angle_count(1e9), 65535);
}

TEST(ForcepsCalibration, RefusesBadFilesByName) {
  const std::pair<std::string, std::string> bad[] = {
      {"filum-forceps/1", "filum-forceps/2"}, {"0.01 deg/count", "0.01 deg"},
      {"0.01 deg/count", "0 deg/count"},      {"-2 mN/count", "nan mN/count"},
      {"limit: 4 N", "limit: 0 N"},           {"zero: 200 count", "zero: 200 mm"},
      {"identity: 42", "identity: -1"},       {"source: weights and protractor", ""},
      {"name: bench pair", "nam: x"}};
  for (const auto& [from, to] : bad) {
    std::string text = kGood;
    text.replace(text.find(from), from.size(), to);
    EXPECT_THROW(ForcepsCalibration::parse(text, "pair.yaml"), InputError) << from << " -> " << to;
  }
}

}  // namespace forceps_calibration_test
}  // namespace filum
