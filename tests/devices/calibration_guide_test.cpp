#include "devices/calibration_guide.h"

#include <gtest/gtest.h>

namespace filum {
namespace calibration_guide_test {

TEST(CalibrationGuide, GoesUpAndDownAndAveragesHalfASecond) {
  CalibrationGuide guide(CalibrationGuide::Channel::force, {0.0, 0.5, 1.0}, 2);
  std::vector<double> asked;
  while (!guide.done()) {
    asked.push_back(guide.value());
    EXPECT_NE(guide.instruction().find("Load the pad"), std::string::npos);
    guide.begin();
    for (std::size_t k = 0; guide.reading(); ++k) {
      DeviceSample s;
      s.has_grip_force = true;
      s.raw_force = 1000 + static_cast<int>(asked.size()) + (k % 2 == 0 ? 1 : -1);
      guide.take(s);
    }
  }
  EXPECT_EQ(asked, (std::vector<double>{0, 0.5, 1, 1, 0.5, 0, 0, 0.5, 1, 1, 0.5, 0}));
  ASSERT_EQ(guide.points().size(), 12u);
  EXPECT_NEAR(guide.points()[4].count, 1005.0, 1e-9);
  EXPECT_NEAR(guide.points()[4].noise, 1.0, 1e-2);
  EXPECT_FALSE(guide.points()[4].upwards);
  EXPECT_TRUE(guide.instruction().empty());
}

TEST(CalibrationGuide, ABrokenWireGivesNoReading) {
  CalibrationGuide guide(CalibrationGuide::Channel::angle, {0.0}, 1);
  guide.begin();
  DeviceSample broken;
  broken.raw_angle = 4092;
  for (int k = 0; k < 2000; ++k) guide.take(broken);
  EXPECT_TRUE(guide.reading());
  guide.again();
  EXPECT_FALSE(guide.reading());
  EXPECT_TRUE(guide.points().empty());
}

TEST(CalibrationGuide, AReadingThatIsNotSteadyIsAskedForAgain) {
  CalibrationGuide guide(CalibrationGuide::Channel::force, {0.0, 1.0}, 1);
  const auto read = [&](int spread) {
    guide.begin();
    for (int k = 0; guide.reading(); ++k) {
      DeviceSample s;
      s.has_grip_force = true;
      s.raw_force = 1000 + (k % 2 == 0 ? spread : -spread);
      guide.take(s);
    }
  };
  read(30);
  EXPECT_NEAR(guide.unsteady(), 30.0, 0.1);
  EXPECT_TRUE(guide.points().empty());
  EXPECT_EQ(guide.value(), 0.0);
  read(15);
  EXPECT_EQ(guide.unsteady(), 0.0);
  EXPECT_EQ(guide.points().size(), 1u);
  EXPECT_EQ(guide.value(), 1.0);
}

TEST(CalibrationGuide, TheLastValueCanBeTakenBack) {
  CalibrationGuide guide(CalibrationGuide::Channel::force, {0.0, 1.0}, 1);
  const auto read = [&](int count, std::size_t samples) {
    guide.begin();
    DeviceSample s;
    s.has_grip_force = true;
    s.raw_force = count;
    for (std::size_t k = 0; k < samples; ++k) guide.take(s);
  };
  guide.undo();
  EXPECT_EQ(guide.value(), 0.0) << "there is nothing to take back";
  read(300, CalibrationGuide::kSamples);
  read(700, 100);
  EXPECT_NEAR(guide.progress(), 0.2, 1e-12);
  guide.undo();
  EXPECT_FALSE(guide.reading());
  EXPECT_EQ(guide.points().size(), 1u) << "first the reading under way";
  read(900, CalibrationGuide::kSamples);
  guide.undo();
  EXPECT_EQ(guide.value(), 1.0);
  read(1200, CalibrationGuide::kSamples);
  EXPECT_NEAR(guide.points().back().count, 1200.0, 1e-9);
}

}  // namespace calibration_guide_test
}  // namespace filum
