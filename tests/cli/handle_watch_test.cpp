#include "cli/handle_watch.h"

#include <gtest/gtest.h>

#include "devices/sample_faults.h"

namespace filum {
namespace handle_watch_test {

DeviceSample saying(std::uint32_t bits, int tool = 0) {
  DeviceSample s;
  s.tool = tool;
  s.buttons = bits;
  return s;
}

TEST(HandleWatch, AFaultIsOneEventAndAWarningWhileItLasts) {
  HandleWatch watch;
  for (int ms = 0; ms < 3000; ++ms) watch.take(saying(ms < 500 ? 1u : kForceSaturated | 1u), 1e-3 * ms);
  ASSERT_EQ(watch.events().size(), 1u);
  EXPECT_STREQ(watch.events()[0].name, "force-saturated");
  EXPECT_NEAR(watch.events()[0].time, 0.5, 1e-9);
  ASSERT_EQ(watch.warnings(3.5).size(), 1u);
  EXPECT_EQ(watch.warnings(3.5)[0].level, "warn");
  EXPECT_TRUE(watch.warnings(4.1).empty());
  watch.take(saying(kForceSaturated), 10.0);  // again, later
  watch.take(saying(kForceSaturated), 10.5);
  EXPECT_EQ(watch.events().size(), 2u);
}

TEST(HandleWatch, TheCalibrationOfAnotherHandleIsSaid) {
  HandleWatch watch;
  watch.take(saying(kForeignCalibration, 1), 2.0);
  ASSERT_EQ(watch.events().size(), 1u);
  EXPECT_STREQ(watch.events()[0].name, "foreign-calibration");
  EXPECT_EQ(watch.events()[0].tool, 1);
  EXPECT_EQ(watch.warnings(2.1)[0].level, "danger");
  EXPECT_NE(watch.warnings(2.1)[0].text.find("not this handle's"), std::string::npos);
}

TEST(HandleWatch, ABrokenWireIsNotAlsoSaturatedAndToolsAreToldApart) {
  HandleWatch watch;
  watch.take(saying(kAngleBroken | kAngleSaturated), 1.0);
  watch.take(saying(kAngleSaturated, 1), 1.0);
  ASSERT_EQ(watch.events().size(), 2u);
  EXPECT_STREQ(watch.events()[0].name, "angle-wire-broken");
  EXPECT_STREQ(watch.events()[1].name, "angle-saturated");
  EXPECT_EQ(watch.warnings(1.0).size(), 2u);
  watch.take(saying(kAngleBroken, 7), 1.0);  // a tool that does not exist
  watch.take(saying(7u), 5.0);               // buttons are no fault
  EXPECT_EQ(watch.events().size(), 2u);
}

}  // namespace handle_watch_test
}  // namespace filum
