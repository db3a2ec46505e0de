#include "devices/replay_device.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace filum {
namespace replay_device_test {

std::vector<DeviceSample> recorded(int n, std::int64_t period_us) {
  std::vector<DeviceSample> samples;
  for (int i = 0; i < n; ++i) {
    DeviceSample s;
    s.has_pose = true;
    s.X_WD.p = {1e-5 * i, 0, 0};
    s.host_time_us = i * period_us;
    s.sequence = static_cast<std::uint32_t>(i);
    samples.push_back(s);
  }
  return samples;
}

TEST(ReplayDevice, EachSampleComesAtItsTimeWhateverTheOrderOfTheList) {
  auto shuffled = recorded(500, 1000);
  std::shuffle(shuffled.begin(), shuffled.end(), std::mt19937(3));
  ReplayDevice device("replay", shuffled);
  std::vector<DeviceSample> out;
  for (std::int64_t now = 0; now < 600'000; now += 700) {
    device.poll(now, out);
    const std::size_t due = static_cast<std::size_t>(std::min<std::int64_t>(500, now / 1000 + 1));
    ASSERT_EQ(out.size(), due) << now;
  }
  for (std::size_t i = 0; i < out.size(); ++i) EXPECT_EQ(out[i].sequence, i);
  EXPECT_EQ(device.health().state, DeviceState::finished);
  EXPECT_EQ(device.health().received, 500u);
}

TEST(ReplayDevice, ALateCallerLosesNothing) {
  ReplayDevice device("replay", recorded(1000, 1000));
  std::vector<DeviceSample> out;
  for (int call = 0; call < 4; ++call) {
    const std::size_t before = out.size();
    device.poll(2'000'000, out);
    ASSERT_LE(out.size() - before, kMaxSamplesPerPoll);
  }
  EXPECT_EQ(out.size(), 1000u);
}

TEST(ReplayDevice, AGapInTheRecordingIsAGapAgain) {
  auto samples = recorded(2, 500'000);
  ReplayDevice device("replay", samples);
  std::vector<DeviceSample> out;
  device.poll(0, out);
  EXPECT_EQ(device.health().state, DeviceState::live);
  device.poll(200'000, out);
  EXPECT_EQ(device.health().state, DeviceState::stale);
  device.poll(500'000, out);
  EXPECT_EQ(device.health().state, DeviceState::live);
}

TEST(ReplayDevice, LeavesOutWhatCannotBe) {
  auto samples = recorded(10, 1000);
  samples[3].X_WD.p.x() = std::nan("");
  samples[4].tool = 12;
  ReplayDevice device("replay", samples);
  std::vector<DeviceSample> out;
  device.poll(1'000'000, out);
  EXPECT_EQ(out.size(), 8u);
  EXPECT_EQ(device.health().rejected, 2u);
}

TEST(ReplayDevice, AHandAsFarAsADeviceMayReportItIsPlayed) {
  auto samples = recorded(2, 1000);
  samples[0].X_WD.p = {0.45, -0.3, 0.25};
  samples[1].X_WD.p.x() = 0.51;
  ReplayDevice device("replay", samples);
  std::vector<DeviceSample> out;
  device.poll(10'000, out);
  EXPECT_EQ(out.size(), 1u);
  EXPECT_EQ(device.health().rejected, 1u);
}

TEST(ReplayDevice, AnEmptyRecordingIsOverAtOnce) {
  ReplayDevice device("replay", {});
  std::vector<DeviceSample> out;
  device.poll(1, out);
  EXPECT_TRUE(out.empty());
  EXPECT_EQ(device.health().state, DeviceState::finished);
}

}  // namespace replay_device_test
}  // namespace filum
