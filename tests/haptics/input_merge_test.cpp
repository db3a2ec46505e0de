#include "haptics/input_merge.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "devices/haptic_link.h"

namespace filum {
namespace input_merge_test {

constexpr std::int64_t kStale = 100'000;

DeviceSample pose(std::int64_t time_us, Vec3 p, Quat q = Quat::Identity(), std::uint32_t buttons = 0) {
  DeviceSample s;
  s.host_time_us = time_us;
  s.has_pose = true;
  s.X_WD = {p, q};
  s.buttons = buttons;
  return s;
}

DeviceSample grip(std::int64_t time_us, double angle, std::uint32_t buttons = 0) {
  DeviceSample s;
  s.host_time_us = time_us;
  s.has_grip_angle = true;
  s.grip_angle = angle;
  s.buttons = buttons;
  return s;
}

DeviceSample squeeze(std::int64_t time_us, double force) {
  DeviceSample s;
  s.host_time_us = time_us;
  s.has_grip_force = true;
  s.grip_force = force;
  return s;
}

TEST(InputMerge, WhatAHandleSaysOfItsFaultsIsNoButton) {
  InputMerge merge;
  merge.take(pose(0, Vec3::Zero()), 0, kStale);
  merge.take(grip(0, 0.1, 0x700 | 2), 1, kStale);
  EXPECT_EQ(merge.inputs(0).tools[0].buttons, 2u);
}

TEST(InputMerge, NothingIsValidBeforeASample) {
  InputMerge merge;
  for (const ToolInput& tool : merge.inputs(0).tools) EXPECT_FALSE(tool.valid);
}

TEST(InputMerge, JoinsAnArmAndForceps) {
  InputMerge merge;
  merge.take(pose(0, {1e-3, 0, 0}), 0, kStale);
  merge.take(grip(500, 0.25), 1, kStale);
  merge.take(squeeze(500, 0.8), 1, kStale);
  const ToolInput tool = merge.inputs(1000).tools[0];
  EXPECT_TRUE(tool.valid && tool.has_grip_force);
  EXPECT_EQ(tool.X_WD.p, Vec3(1e-3, 0, 0));
  EXPECT_EQ(tool.grip_angle, 0.25);
  EXPECT_EQ(tool.grip_force, 0.8);
  EXPECT_FALSE(merge.inputs(1000).tools[1].valid);
}

TEST(InputMerge, TheNewestReadingOfADeviceCountsWhateverTheOrder) {
  InputMerge merge;
  merge.take(pose(2000, {2e-3, 0, 0}), 0, kStale);
  merge.take(pose(1000, {1e-3, 0, 0}), 0, kStale);
  EXPECT_EQ(merge.inputs(2000).tools[0].X_WD.p.x(), 2e-3);
}

TEST(InputMerge, TheFirstDeviceIsBelievedAsLongAsItSpeaks) {
  InputMerge merge;
  const auto angle = [&](std::int64_t now) { return merge.inputs(now).tools[0].grip_angle; };
  merge.take(pose(0, {0, 0, 0}), 1, 10 * kStale);  // a pointer that also guesses the grip
  merge.take(grip(0, 0.3), 1, 10 * kStale);
  EXPECT_EQ(angle(0), 0.3);
  merge.take(grip(1000, 0.1), 0, kStale);  // forceps
  EXPECT_EQ(angle(1000), 0.1);
  merge.take(grip(2000, 0.31), 1, 10 * kStale);
  EXPECT_EQ(angle(2000), 0.1) << "the pointer does not talk over the forceps";
  merge.take(grip(200'000, 0.32), 1, 10 * kStale);
  EXPECT_EQ(angle(200'000), 0.32) << "the forceps fell silent";
  merge.take(grip(201'000, 0.12), 0, kStale);
  EXPECT_EQ(angle(201'000), 0.12);
  merge.drop(0);
  merge.take(grip(201'500, 0.33), 1, 10 * kStale);
  EXPECT_EQ(angle(201'500), 0.33);
}

TEST(InputMerge, AgeMakesInvalidAndKeepsTheLastPose) {
  InputMerge merge;
  merge.take(pose(0, {1e-3, 0, 0}), 0, kStale);
  EXPECT_TRUE(merge.inputs(kStale).tools[0].valid);
  const ToolInput old = merge.inputs(kStale + 1).tools[0];
  EXPECT_FALSE(old.valid);
  EXPECT_EQ(old.X_WD.p.x(), 1e-3);
  merge.take(pose(kStale + 2, {3e-3, 0, 0}), 0, kStale);
  EXPECT_TRUE(merge.inputs(kStale + 2).tools[0].valid);
}

TEST(InputMerge, AGripThatFellSilentMakesInvalidASqueezeJustAbsent) {
  InputMerge merge;
  merge.take(grip(0, 0.2), 1, kStale);
  merge.take(squeeze(0, 0.5), 2, kStale);
  merge.take(pose(0, {0, 0, 0}), 0, kStale);
  EXPECT_TRUE(merge.inputs(0).tools[0].valid);
  merge.take(pose(200'000, {0, 0, 0}), 0, kStale);
  EXPECT_FALSE(merge.inputs(200'000).tools[0].valid);
  merge.take(grip(200'000, 0.2), 1, kStale);
  const ToolInput tool = merge.inputs(200'000).tools[0];
  EXPECT_TRUE(tool.valid);
  EXPECT_FALSE(tool.has_grip_force);
}

TEST(InputMerge, ALostDeviceIsDroppedAtOnceAndOnlyIt) {
  InputMerge merge;
  merge.take(pose(0, {0, 0, 0}), 0, kStale);
  DeviceSample other = pose(0, {1e-3, 0, 0});
  other.tool = 1;
  merge.take(other, 1, kStale);
  merge.drop(0);
  EXPECT_FALSE(merge.inputs(0).tools[0].valid);
  EXPECT_TRUE(merge.inputs(0).tools[1].valid);
}

TEST(InputMerge, NaNNeverReachesTheWorld) {
  InputMerge merge;
  merge.take(pose(0, {1e-3, 0, 0}), 0, kStale);
  merge.take(pose(1, {std::nan(""), 0, 0}), 0, kStale);
  merge.take(pose(2, {9.0, 0, 0}), 0, kStale);
  DeviceSample wild = pose(3, {0, 0, 0});
  wild.tool = -4;
  merge.take(wild, 0, kStale);
  merge.take(pose(4, {0, 0, 0}), 99, kStale);
  const ToolInput tool = merge.inputs(10).tools[0];
  EXPECT_TRUE(tool.valid);
  EXPECT_EQ(tool.X_WD.p.x(), 1e-3);
}

/// Poses that a link and a tracker let through: what they count as received is not thrown away here.
TEST(InputMerge, AHandAsFarAsADeviceMayReportItMovesTheTool) {
  for (const double factor : {1.0, 0.1}) {
    InputMerge merge({factor, Vec3::Zero()});
    DeviceSample linked;
    ASSERT_TRUE(sample_of(link_pose(0, {{0.45, -0.3, 0.25}, Quat::Identity()}, 0.1, 0.0, FILUM_LINK_TRACKED), linked));
    merge.take(linked, 0, kStale);
    const ToolInput tool = merge.inputs(0).tools[0];
    ASSERT_TRUE(tool.valid) << factor;
    EXPECT_LT((tool.X_WD.p - factor * Vec3(0.45, -0.3, 0.25)).norm(), 1e-7);
  }
}

TEST(InputMerge, AToolThatWouldBeOutOfTheScenesReachHasNoInput) {
  InputMerge merge({10.0, Vec3::Zero()});
  merge.take(pose(0, {0.04, 0, 0}), 0, kStale);
  EXPECT_TRUE(merge.inputs(0).tools[0].valid);
  merge.take(pose(1000, {0.06, 0, 0}), 0, kStale);
  const ToolInput away = merge.inputs(1000).tools[0];
  EXPECT_FALSE(away.valid) << "0.6 m away in the scene";
  EXPECT_EQ(away.X_WD.p.x(), 0.4);
  merge.take(pose(2000, {0.03, 0, 0}), 0, kStale);
  EXPECT_TRUE(merge.inputs(2000).tools[0].valid);
}

TEST(InputMerge, TheClutchDoesNotCarryAToolOutOfReach) {
  InputMerge merge;
  std::int64_t now = 0;
  ToolInput tool;
  for (int stroke = 0; stroke < 10; ++stroke) {  // along by 0.1 m, back with the clutch held
    for (const auto& [x, buttons] : std::vector<std::pair<double, std::uint32_t>>{{0.0, 0}, {0.1, 0}, {0.1, 1}, {0.0, 1}}) {
      merge.take(pose(now += 1000, {x, 0, 0}, Quat::Identity(), buttons), 0, kStale);
      tool = merge.inputs(now).tools[0];
      ASSERT_LE(tool.X_WD.p.x(), 0.5) << stroke;
    }
  }
  EXPECT_FALSE(tool.valid);
}

TEST(InputMerge, TheClutchHoldsTheToolAndLetsGoWithoutAJump) {
  InputMerge merge;
  const Quat turned(Eigen::AngleAxisd(0.7, Vec3::UnitY()));
  merge.take(pose(0, {1e-3, 0, 0}), 0, kStale);
  merge.inputs(0);
  Pose held;
  for (int i = 1; i <= 50; ++i) {  // hand moves and turns with the clutch held
    const double s = i / 50.0;
    merge.take(pose(i * 1000, {1e-3 + 0.05 * s, -0.02 * s, 0}, Quat::Identity().slerp(s, turned), 1), 0,
               kStale);
    const ToolInput tool = merge.inputs(i * 1000).tools[0];
    if (i == 1) held = tool.X_WD;
    ASSERT_TRUE(tool.valid);
    ASSERT_EQ(tool.X_WD.p, held.p);
    ASSERT_EQ(tool.X_WD.q.coeffs(), held.q.coeffs());
  }
  merge.take(pose(51'000, {51e-3, -0.02, 0}, turned, 0), 0, kStale);
  Pose tool = merge.inputs(51'000).tools[0].X_WD;
  EXPECT_LT((tool.p - held.p).norm(), 1e-15);
  EXPECT_LT(tool.q.angularDistance(held.q), 1e-7);
  merge.take(pose(52'000, {52e-3, -0.02, 1e-3}, turned, 0), 0, kStale);
  tool = merge.inputs(52'000).tools[0].X_WD;
  EXPECT_LT((tool.p - held.p - Vec3(1e-3, 0, 1e-3)).norm(), 1e-15) << "moves with the hand again";
}

TEST(InputMerge, APedalOnAnotherDeviceHoldsTheClutch) {
  InputMerge merge;
  merge.take(grip(0, 0.2, 1), 1, kStale);  // the pedal hangs on the forceps, the pose comes from an arm
  merge.take(pose(0, {0, 0, 0}), 0, kStale);
  EXPECT_EQ(merge.inputs(0).tools[0].buttons, 1u);
  merge.take(pose(1000, {5e-3, 0, 0}), 0, kStale);
  EXPECT_EQ(merge.inputs(1000).tools[0].X_WD.p.x(), 0.0);
}

}  // namespace input_merge_test
}  // namespace filum
