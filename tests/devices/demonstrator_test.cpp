#include "devices/demonstrator.h"

#include <gtest/gtest.h>

namespace filum {
namespace {

const char* kScript = R"(
format: filum-demonstration/1
title: Two hands
tools:
  - tool: 0
    keys:
      - { t: "0 s", p: ["0 mm", "0 mm", "0 mm"], handle: [0, 0, 1], opening: [1, 0, 0], grip: "0 deg" }
      - { t: "1 s", p: ["5 mm", "0 mm", "0 mm"], grip: "20 deg" }
  - tool: 1
    keys:
      - { t: "0 s", p: ["9 mm", "0 mm", "0 mm"], handle: [0, 0, 1], opening: [1, 0, 0], grip: "5 deg" }
)";

std::vector<DeviceSample> play(Demonstrator& device, std::int64_t step_us, std::int64_t end_us) {
  std::vector<DeviceSample> all, out;
  for (std::int64_t now = 0; now <= end_us; now += step_us) {
    out.clear();
    device.poll(now, out);
    EXPECT_LE(out.size(), kMaxSamplesPerPoll);
    all.insert(all.end(), out.begin(), out.end());
  }
  return all;
}

TEST(Demonstrator, SamplesDoNotDependOnWhenItIsPolled) {
  const PoseScript script = PoseScript::parse(kScript, "two.yaml");
  Demonstrator often(script), seldom(script);
  const auto a = play(often, 500, 1'000'000), b = play(seldom, 50'000, 1'000'000);
  ASSERT_EQ(a.size(), 2u * 1001u);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].tool, b[i].tool);
    EXPECT_EQ(a[i].host_time_us, b[i].host_time_us);
    EXPECT_EQ(a[i].X_WD.p, b[i].X_WD.p);
    EXPECT_EQ(a[i].sequence, b[i].sequence);
  }
  EXPECT_EQ(often.health().lost, 0u);
  EXPECT_EQ(often.health().received, a.size());
}

TEST(Demonstrator, GivesThePosesOfTheScript) {
  const PoseScript script = PoseScript::parse(kScript, "two.yaml");
  Demonstrator device(script);
  for (const DeviceSample& sample : play(device, 1000, 1'000'000)) {
    const DeviceSample expected = script.at(sample.tool, static_cast<double>(sample.host_time_us) * 1e-6);
    EXPECT_EQ(sample.X_WD.p, expected.X_WD.p);
    EXPECT_EQ(sample.grip_angle, expected.grip_angle);
    EXPECT_TRUE(sample.has_pose && sample.has_grip_angle);
  }
}

TEST(Demonstrator, ALateCallerGetsTheNewestAndTheRestIsCounted) {
  Demonstrator device(PoseScript::parse(kScript, "two.yaml"));
  std::vector<DeviceSample> out;
  device.poll(900'000, out);
  ASSERT_FALSE(out.empty());
  EXPECT_LE(out.size(), kMaxSamplesPerPoll);
  EXPECT_EQ(out.back().host_time_us, 900'000);
  EXPECT_EQ(device.health().received + device.health().lost, 2u * 901u);
}

TEST(Demonstrator, FinishesAfterTheLastKeyAndHoldsIt) {
  Demonstrator device(PoseScript::parse(kScript, "two.yaml"));
  std::vector<DeviceSample> out;
  EXPECT_EQ(device.health().state, DeviceState::waiting);
  device.poll(500'000, out);
  EXPECT_EQ(device.health().state, DeviceState::live);
  out.clear();
  device.poll(1'500'000, out);
  EXPECT_EQ(device.health().state, DeviceState::finished);
  for (const DeviceSample& s : out)
    if (s.tool == 0 && s.host_time_us > 1'000'000) {
      EXPECT_EQ(s.X_WD.p, Vec3(5e-3, 0, 0));
    }
}

}  // namespace
}  // namespace filum
