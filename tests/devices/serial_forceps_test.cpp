#include "devices/serial_forceps.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <functional>
#include <thread>

#include "base/error.h"
#include "tests/devices/pty.h"
#include "tests/devices/script_frames.h"

namespace filum {
namespace serial_forceps_test {

using namespace std::chrono_literals;

ForcepsCalibration calibration() {
  return ForcepsCalibration::load(std::string(FILUM_SOURCE_DIR) + "/models/forceps/default.yaml");
}

PoseScript script() {
  return PoseScript::parse(R"(
format: filum-demonstration/1
title: Two hands
tools:
  - tool: 0
    keys:
      - { t: "0 s", p: ["-4 mm", "0 mm", "6 mm"], handle: [0, 0, 1], opening: [1, 0, 0], grip: "2 deg" }
      - { t: "1 s", p: ["4 mm", "1 mm", "6 mm"], handle: [0, 1, 1], grip: "20 deg", buttons: [cut] }
  - tool: 1
    keys:
      - { t: "0 s", p: ["9 mm", "0 mm", "0 mm"], handle: [0, 0, 1], opening: [1, 0, 0], grip: "5 deg", grip_force: "0.5 N" }
      - { t: "1 s", p: ["0 mm", "0 mm", "0 mm"], grip_force: "1.5 N" }
)",
                           "two.yaml");
}

std::int64_t steady_us() {
  return std::chrono::duration_cast<std::chrono::microseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

/// Polls until `done` or for 20 s, about a thousand times a second.
std::vector<DeviceSample> poll_until(SerialForceps& device, const std::function<bool(std::size_t)>& done) {
  std::vector<DeviceSample> out;
  const auto end = std::chrono::steady_clock::now() + 20s;
  while (std::chrono::steady_clock::now() < end && !done(out.size())) {
    device.poll(steady_us(), out);
    std::this_thread::sleep_for(500us);
  }
  return out;
}

TEST(SerialForceps, NamesAPortThatCannotBeOpened) {
  try {
    SerialForceps device("/dev/no-such-port", calibration());
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("/dev/no-such-port"), std::string::npos) << error.what();
  }
  EXPECT_THROW(SerialForceps("/dev/null", calibration()), InputError) << "no terminal";
  Pty pty;
  EXPECT_THROW(SerialForceps(pty.path(), calibration(), 12345), InputError) << "no such rate";
}

TEST(SerialForceps, ReadsEveryFrameThatIsSentAtAKilohertz) {
  Pty pty;
  SerialForceps device(pty.path(), calibration());
  EXPECT_EQ(device.health().state, DeviceState::waiting);
  ScriptFrames frames(script(), calibration());
  constexpr int kTicks = 1000;
  std::jthread hand([&] {
    auto due = std::chrono::steady_clock::now();
    for (int i = 0; i < kTicks; ++i, due += 1ms) {
      std::vector<std::vector<std::uint8_t>> now;
      frames.append(1e-3 * i, now);
      for (const auto& frame : now)
        if (!pty.write(frame)) return;
      std::this_thread::sleep_until(due);
    }
  });
  const auto samples = poll_until(device, [](std::size_t n) { return n >= 4 * kTicks; });
  ASSERT_EQ(samples.size(), 4u * kTicks);
  EXPECT_EQ(device.health().state, DeviceState::live);
  EXPECT_EQ(device.health().received, 4u * kTicks);
  EXPECT_EQ(device.health().lost, 0u);
  EXPECT_EQ(device.health().corrupt, 0u);
  EXPECT_EQ(device.health().rejected, 0u);
  const PoseScript expected = script();
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const DeviceSample& s = samples[i];
    ASSERT_EQ(s.sequence, i);
    const DeviceSample e = expected.at(s.tool, 1e-3 * static_cast<double>(i / 4));
    if (s.has_pose) {
      ASSERT_LT((s.X_WD.p - e.X_WD.p).norm(), 1e-7);
    }
    if (s.has_grip_angle) {
      ASSERT_NEAR(s.grip_angle, e.grip_angle, 1e-4);
    }
    ASSERT_EQ(s.has_grip_force, s.tool == 1 && s.has_grip_angle);
    if (s.has_grip_force) {
      ASSERT_NEAR(s.grip_force, e.grip_force, 1e-3);
    }
    ASSERT_EQ(s.buttons, e.buttons);
  }
}

TEST(SerialForceps, CountsDamageAndLossAndUsesNeither) {
  Pty pty;
  SerialForceps device(pty.path(), calibration());
  ScriptFrames frames(script(), calibration());
  const std::uint8_t zero = 0;
  pty.write(std::span(&zero, 1));
  std::uint64_t damaged = 0, dropped = 0, good = 0;
  for (int i = 0; i < 100; ++i) {
    std::vector<std::vector<std::uint8_t>> now;
    frames.append(1e-3 * i, now);
    for (std::size_t k = 0; k < now.size(); ++k) {
      if (i % 10 == 4 && k == 1) {
        now[k][3] = static_cast<std::uint8_t>(now[k][3] ^ 0x40);
        if (now[k][3] == 0) now[k][3] = 0x41;
        ++damaged;
      } else if (i % 10 == 7 && k == 2) {
        ++dropped;
        continue;
      } else {
        ++good;
      }
      ASSERT_TRUE(pty.write(now[k]));
      std::vector<DeviceSample> unused;
      device.poll(steady_us(), unused);
    }
  }
  poll_until(device, [&](std::size_t) { return device.health().received >= good; });
  EXPECT_EQ(device.health().received, good);
  EXPECT_EQ(device.health().corrupt, damaged);
  EXPECT_EQ(device.health().lost, damaged + dropped);
}

TEST(SerialForceps, GoesStaleAndComesBack) {
  Pty pty;
  SerialForceps device(pty.path(), calibration());
  ScriptFrames frames(script(), calibration());
  const auto send = [&](double t) {
    std::vector<std::vector<std::uint8_t>> now;
    frames.append(t, now);
    for (const auto& frame : now) ASSERT_TRUE(pty.write(frame));
  };
  std::vector<DeviceSample> out;
  std::int64_t now = 0;
  send(0.0);
  while (out.size() < 4) device.poll(now, out);
  EXPECT_EQ(device.health().state, DeviceState::live);
  device.poll(now += 100'000, out);
  EXPECT_EQ(device.health().state, DeviceState::live);
  device.poll(now += 1, out);
  EXPECT_EQ(device.health().state, DeviceState::stale);
  send(0.2);
  while (out.size() < 8) device.poll(now, out);
  EXPECT_EQ(device.health().state, DeviceState::live);
}

TEST(SerialForceps, PulledOutAndPutBackGoesOnByItself) {
  const auto link = std::filesystem::temp_directory_path() / ("filum-forceps-" + std::to_string(::getpid()));
  Pty pty(link.string());
  SerialForceps device(link.string(), calibration());
  for (int time = 0; time < 3; ++time) {
    ScriptFrames frames(script(), calibration());
    std::vector<std::vector<std::uint8_t>> now{frames.hello(0.0)};
    frames.append(0.0, now);
    const std::uint64_t before = device.health().received;
    // What is sent before the port is open again is nobody's: keep sending, as a handle does.
    double t = 0.0;
    poll_until(device, [&](std::size_t) {
      for (const auto& frame : now) pty.write(frame);
      now.clear();
      frames.append(t += 1e-3, now);
      return device.health().state == DeviceState::live && device.health().received > before + 20;
    });
    ASSERT_EQ(device.health().state, DeviceState::live) << "time " << time;
    pty.unplug();
    poll_until(device, [&](std::size_t) { return device.health().state == DeviceState::lost; });
    ASSERT_EQ(device.health().state, DeviceState::lost) << "time " << time;
    pty.plug();
  }
  EXPECT_EQ(device.health().corrupt, 0u) << "half a frame at the break is nobody's fault";
}

TEST(SerialForceps, MeasuresTheOffsetOfTheClock) {
  Pty pty;
  SerialForceps device(pty.path(), calibration());
  ScriptFrames frames(script(), calibration());
  FrameReader heard;
  std::array<std::uint8_t, 256> bytes;
  const std::int64_t start = steady_us();
  poll_until(device, [&](std::size_t) {
    const ssize_t n = pty.read(bytes);
    if (n > 0) {
      heard.feed(std::span(bytes).first(static_cast<std::size_t>(n)), [&](const filum_frame& frame) {
        filum_ping ping;
        if (filum_get_ping(&frame, &ping))
          pty.write(frames.pong(ping, 1e-6 * static_cast<double>(steady_us() - start)));
      });
    }
    return device.stream().clock().known();
  });
  ASSERT_TRUE(device.stream().clock().known());
  const ClockSync& clock = device.stream().clock();
  EXPECT_LE(std::llabs(clock.offset_us() + start), clock.uncertainty_us() + 2);
}

}  // namespace serial_forceps_test
}  // namespace filum
