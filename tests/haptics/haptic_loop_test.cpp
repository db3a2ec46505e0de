#include "haptics/haptic_loop.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <stdexcept>

#include "devices/demonstrator.h"
#include "devices/pointer_device.h"
#include "devices/serial_forceps.h"
#include "tests/allocation_count.h"
#include "tests/devices/pty.h"
#include "tests/devices/script_frames.h"

namespace filum {
namespace haptic_loop_test {

const char* kScript = R"(
format: filum-demonstration/1
title: Two hands
tools:
  - tool: 0
    keys:
      - { t: 0 s, p: [0 mm, 0 mm, 0 mm], handle: [0, 0, 1], opening: [1, 0, 0], grip: 0 deg }
      - { t: 10 s, p: [5 mm, 0 mm, 0 mm], grip: 20 deg }
  - tool: 1
    keys:
      - { t: 0 s, p: [9 mm, 0 mm, 0 mm], handle: [0, 0, 1], opening: [1, 0, 0], grip: 5 deg }
)";

PoseScript script() {
  return PoseScript::parse(kScript, "two.yaml");
}

std::vector<std::unique_ptr<Device>> only(std::unique_ptr<Device> device) {
  std::vector<std::unique_ptr<Device>> devices;
  devices.push_back(std::move(device));
  return devices;
}

DeviceSample at(double x) {
  DeviceSample s;
  s.has_pose = true;
  s.X_WD.p = {x, 0, 0};
  return s;
}

void show_tool(HapticLoop& loop, std::int64_t now_us, const Vec3& p, const Vec3& f = Vec3::Zero()) {
  ToolStates& states = loop.tool_states().write_slot();
  states.time_us = now_us;
  states.tools[0] = {p, Vec3::Zero(), f, true};
  loop.tool_states().publish();
}

TEST(HapticLoop, TakesTheScriptToTheInputs) {
  HapticLoop loop(only(std::make_unique<Demonstrator>(script())));
  const PoseScript expected = script();
  for (std::int64_t now = 0; now <= 2'000'000; now += 1000) {
    loop.tick(now);
    const Inputs& inputs = loop.inputs().read();
    for (int tool = 0; tool < 2; ++tool) {
      const ToolInput& input = inputs.tools[static_cast<std::size_t>(tool)];
      ASSERT_TRUE(input.valid);
      ASSERT_LT((input.X_WD.p - expected.at(tool, 1e-6 * static_cast<double>(now)).X_WD.p).norm(), 1e-15);
    }
    ASSERT_FALSE(inputs.tools[2].valid);
  }
  const HapticReport& report = loop.report().read();
  EXPECT_EQ(report.ticks, 2001u);
  EXPECT_EQ(report.devices[0].received, 2u * 2001u);
  EXPECT_EQ(report.period_p99_us, 1000);
}

TEST(HapticLoop, EverySampleIsThereForTheRecorderAndWhatItMissesIsCounted) {
  HapticOptions options;
  options.sample_queue = 1000;
  HapticLoop loop(only(std::make_unique<Demonstrator>(script())), options);
  for (std::int64_t now = 0; now < 400'000; now += 1000) loop.tick(now);
  DeviceSample sample;
  std::uint32_t expected = 0;
  std::uint64_t taken = 0;
  while (loop.samples().pop(sample)) {
    if (sample.tool == 0) {
      ASSERT_EQ(sample.sequence, expected++);
    }
    ++taken;
  }
  EXPECT_EQ(taken, 800u);
  EXPECT_EQ(loop.report().read().samples_dropped, 0u);
  for (std::int64_t now = 400'000; now < 1'000'000; now += 1000) loop.tick(now);
  EXPECT_EQ(loop.report().read().samples_dropped, 200u);
}

TEST(HapticLoop, RendersTheForceOfTheSceneAndPassesItOn) {
  auto pointer = std::make_unique<PointerDevice>();
  PointerDevice& hand = *pointer;
  HapticLoop loop(only(std::move(pointer)));
  hand.connected();
  for (std::int64_t now = 0; now < 100'000; now += 1000) {
    hand.push(at(0.0));
    if (now % 2000 == 0) show_tool(loop, now, {0.2e-3, 0, 0}, {0.1, 0, 0});
    loop.tick(now);
  }
  EXPECT_NEAR(loop.report().read().hand_force[0].x(), 0.1, 1e-9);
  EXPECT_EQ(loop.report().read().scene_force[0].x(), 0.1);
  EXPECT_TRUE(loop.report().read().valid[0]);
}

TEST(HapticLoop, ALostHandGetsNoForceWithinTwoMilliseconds) {
  auto pointer = std::make_unique<PointerDevice>();
  PointerDevice& hand = *pointer;
  HapticLoop loop(only(std::move(pointer)));
  hand.connected();
  std::int64_t now = 0;
  for (; now < 50'000; now += 1000) {
    hand.push(at(0.0));
    show_tool(loop, now, {5e-3, 0, 0});
    loop.tick(now);
  }
  ASSERT_GT(loop.report().read().hand_force[0].norm(), 1.0);
  hand.disconnected();
  show_tool(loop, now, {5e-3, 0, 0});
  loop.tick(now += 1000);
  EXPECT_EQ(loop.report().read().hand_force[0].norm(), 0.0);
  EXPECT_FALSE(loop.inputs().read().tools[0].valid);
}

TEST(HapticLoop, NoForceFromAWorldThatFellSilentNorWithTheClutchHeld) {
  auto pointer = std::make_unique<PointerDevice>();
  PointerDevice& hand = *pointer;
  HapticLoop loop(only(std::move(pointer)));
  hand.connected();
  const auto tick = [&](std::int64_t now, std::uint32_t buttons) {
    DeviceSample sample = at(0.0);
    sample.buttons = buttons;
    hand.push(sample);
    loop.tick(now);
    return loop.report().read().hand_force[0].norm();
  };
  EXPECT_EQ(tick(0, 0), 0.0) << "no state was ever shown";
  show_tool(loop, 1000, {1e-3, 0, 0});
  EXPECT_GT(tick(1000, 0), 0.0);
  EXPECT_EQ(tick(2000, 1), 0.0) << "clutch";
  EXPECT_GT(tick(3000, 0), 0.0);
  EXPECT_GT(tick(51'000, 0), 0.0);
  EXPECT_EQ(tick(51'001, 0), 0.0) << "50 ms without the world";
}

TEST(HapticLoop, ATickAllocatesNothing) {
  Pty pty;
  const auto calibration =
      ForcepsCalibration::load(std::string(FILUM_SOURCE_DIR) + "/models/forceps/default.yaml");
  auto pointer = std::make_unique<PointerDevice>();
  PointerDevice& hand = *pointer;
  std::vector<std::unique_ptr<Device>> devices;
  devices.push_back(std::make_unique<SerialForceps>(pty.path(), calibration));
  devices.push_back(std::move(pointer));
  devices.push_back(std::make_unique<Demonstrator>(script()));
  HapticLoop loop(std::move(devices));
  ScriptFrames frames(script(), calibration);
  hand.connected();
  std::int64_t now = 0;
  for (int i = 0; i < 600; ++i, now += 1000) {
    std::vector<std::vector<std::uint8_t>> wire;
    frames.append(1e-6 * static_cast<double>(now), wire);
    if (i % 5 == 0)
      wire[0][4] = static_cast<std::uint8_t>(wire[0][4] ^ 0x11);  // damage takes no other way out
    if (i >= 400) wire.clear();
    for (const auto& frame : wire) ASSERT_TRUE(pty.write(frame));
    hand.push(i % 7 == 0 ? at(std::nan("")) : at(1e-3));
    show_tool(loop, now, {1e-3, 1e-3, 0});
    if (i == 450) pty.unplug();
    const long before = allocations;
    loop.tick(now);
    ASSERT_EQ(allocations, before) << "tick " << i;
  }
  EXPECT_GT(loop.report().read().devices[0].received, 1000u);
  EXPECT_EQ(loop.report().read().devices[0].state, DeviceState::lost);
  const long before = allocations;
  ::operator delete(::operator new(1));
  EXPECT_EQ(allocations, before + FILUM_COUNTS_ALLOCATIONS) << "the counter counts";
}

TEST(HapticLoop, RunsInAThreadOfItsOwnAndStops) {
  HapticLoop loop(only(std::make_unique<Demonstrator>(script())));
  loop.start();
  std::uint64_t taken = 0, seen = 0, last_ticks = 0;
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  DeviceSample sample;
  while (seen < 200 && std::chrono::steady_clock::now() < end) {  // another thread plays world and recorder
    if (loop.inputs().fresh() && loop.inputs().read().tools[0].valid) ++seen;
    show_tool(loop, 0, Vec3::Zero());
    while (loop.samples().pop(sample)) ++taken;
    const HapticReport& report = loop.report().read();
    ASSERT_GE(report.ticks, last_ticks);
    last_ticks = report.ticks;
    std::this_thread::sleep_for(std::chrono::microseconds(700));
  }
  loop.stop();
  while (loop.samples().pop(sample)) ++taken;
  EXPECT_GE(seen, 200u);
  const HapticReport& report = loop.report().read();
  EXPECT_GE(report.ticks, 200u);
  EXPECT_EQ(taken + report.samples_dropped, report.devices[0].received);
  const std::uint64_t ticks = report.ticks;
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_EQ(loop.report().read().ticks, ticks) << "stopped";
}

TEST(HapticLoop, RefusesMoreDevicesThanItCanPoll) {
  std::vector<std::unique_ptr<Device>> devices;
  for (int i = 0; i <= InputMerge::kMaxSources; ++i) devices.push_back(std::make_unique<PointerDevice>());
  EXPECT_THROW(HapticLoop(std::move(devices)), std::invalid_argument);
}

TEST(HapticLoop, ReadsTheToolsOffAnObservation) {
  Observation observation;
  observation.n_tools = 2;
  observation.tools[1].X_WT.p = {1, 2, 3};
  observation.tools[1].f_T_W = {4, 5, 6};
  const ToolStates states = tool_states_of(observation, 77);
  EXPECT_EQ(states.time_us, 77);
  EXPECT_TRUE(states.tools[0].present && states.tools[1].present);
  EXPECT_FALSE(states.tools[2].present);
  EXPECT_EQ(states.tools[1].p_WT, Vec3(1, 2, 3));
  EXPECT_EQ(states.tools[1].f_T_W, Vec3(4, 5, 6));
}

}  // namespace haptic_loop_test
}  // namespace filum
