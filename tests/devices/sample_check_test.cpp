#include "devices/sample_check.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace filum {
namespace sample_check_test {

DeviceSample good() {
  DeviceSample s;
  s.has_pose = s.has_grip_angle = s.has_grip_force = true;
  return s;
}

TEST(SampleCheck, RefusesWhatCannotBe) {
  const double nan = std::nan(""), infinite = std::numeric_limits<double>::infinity();
  EXPECT_EQ(fault_of(good()), SampleFault::none);
  const auto with = [](auto change) {
    DeviceSample s = good();
    change(s);
    return fault_of(s);
  };
  EXPECT_EQ(with([](auto& s) { s.tool = -1; }), SampleFault::wrong_tool);
  EXPECT_EQ(with([](auto& s) { s.tool = kMaxTools; }), SampleFault::wrong_tool);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(with([&](auto& s) { s.X_WD.p[i] = nan; }), SampleFault::not_finite);
    EXPECT_EQ(with([&](auto& s) { s.X_WD.p[i] = -infinite; }), SampleFault::not_finite);
    EXPECT_EQ(with([&](auto& s) { s.X_WD.p[i] = 0.51; }), SampleFault::out_of_range);
    EXPECT_EQ(with([&](auto& s) { s.X_WD.p[i] = -0.49; }), SampleFault::none);
  }
  for (int i = 0; i < 4; ++i)
    EXPECT_EQ(with([&](auto& s) { s.X_WD.q.coeffs()[i] = nan; }), SampleFault::not_finite);
  EXPECT_EQ(with([](auto& s) { s.X_WD.q = Quat(0.9, 0, 0, 0); }), SampleFault::out_of_range);
  EXPECT_EQ(with([](auto& s) { s.X_WD.q = Quat(0, 0, 0, 0); }), SampleFault::out_of_range);
  EXPECT_EQ(with([&](auto& s) { s.grip_angle = nan; }), SampleFault::not_finite);
  EXPECT_EQ(with([](auto& s) { s.grip_angle = 4.0; }), SampleFault::out_of_range);
  EXPECT_EQ(with([&](auto& s) { s.grip_force = infinite; }), SampleFault::not_finite);
  EXPECT_EQ(with([](auto& s) { s.grip_force = -0.1; }), SampleFault::out_of_range);
}

TEST(SampleCheck, LooksOnlyAtWhatIsPresent) {
  DeviceSample s;
  s.X_WD.p.setConstant(std::nan(""));
  s.grip_force = -1;
  EXPECT_EQ(fault_of(s), SampleFault::none);
}

}  // namespace sample_check_test
}  // namespace filum
