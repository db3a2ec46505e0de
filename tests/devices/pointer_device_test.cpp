#include "devices/pointer_device.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <thread>

namespace filum {
namespace pointer_device_test {

DeviceSample at(double x, int tool = 0) {
  DeviceSample s;
  s.tool = tool;
  s.has_pose = s.has_grip_angle = true;
  s.X_WD.p = {x, 0, 0};
  s.grip_angle = 0.2;
  return s;
}

TEST(PointerDevice, HandsOverWhatWasPushedInOrder) {
  PointerDevice device;
  EXPECT_EQ(device.health().state, DeviceState::waiting);
  device.connected();
  for (int i = 0; i < 10; ++i) EXPECT_EQ(device.push(at(0.01 * i)), SampleFault::none);
  std::vector<DeviceSample> out;
  device.poll(5000, out);
  ASSERT_EQ(out.size(), 10u);
  for (std::size_t i = 0; i < 10; ++i) {
    EXPECT_EQ(out[i].X_WD.p.x(), 0.01 * static_cast<double>(i));
    EXPECT_EQ(out[i].host_time_us, 5000);
    EXPECT_EQ(out[i].sequence, i);
  }
  EXPECT_EQ(device.health().state, DeviceState::live);
  EXPECT_EQ(device.health().received, 10u);
}

TEST(PointerDevice, RefusesNaNAndNonsense) {
  PointerDevice device;
  device.connected();
  EXPECT_EQ(device.push(at(std::nan(""))), SampleFault::not_finite);
  EXPECT_EQ(device.push(at(1.0)), SampleFault::out_of_range);
  EXPECT_EQ(device.push(at(0.0, 3)), SampleFault::wrong_tool);
  std::vector<DeviceSample> out;
  device.poll(0, out);
  EXPECT_TRUE(out.empty());
  EXPECT_EQ(device.health().rejected, 3u);
}

TEST(PointerDevice, ABrowserThatGoesAndComesBack) {
  PointerDevice device;
  std::vector<DeviceSample> out;
  device.connected();
  device.push(at(0.01));
  device.poll(1000, out);
  device.push(at(0.02));
  device.disconnected();
  out.clear();
  device.poll(2000, out);
  EXPECT_TRUE(out.empty()) << "a pose from before the break is no longer true";
  EXPECT_EQ(device.health().state, DeviceState::lost);
  device.connected();
  device.push(at(0.03));
  device.poll(3000, out);
  ASSERT_EQ(out.size(), 1u);
  EXPECT_EQ(device.health().state, DeviceState::live);
}

TEST(PointerDevice, IsStaleAfterASecondOfSilence) {
  PointerDevice device;
  std::vector<DeviceSample> out;
  device.connected();
  device.push(at(0.01));
  device.poll(0, out);
  device.poll(1'000'000, out);
  EXPECT_EQ(device.health().state, DeviceState::live);
  device.poll(1'000'001, out);
  EXPECT_EQ(device.health().state, DeviceState::stale);
}

TEST(PointerDevice, AFloodIsCountedAsLoss) {
  PointerDevice device;
  device.connected();
  for (int i = 0; i < 5000; ++i) device.push(at(0.0));
  std::vector<DeviceSample> out;
  for (int i = 0; i < 100; ++i) {
    const std::size_t before = out.size();
    device.poll(i, out);
    ASSERT_LE(out.size() - before, kMaxSamplesPerPoll);
  }
  device.push(at(0.0));
  device.poll(200, out);
  EXPECT_EQ(out.size() + device.health().lost, 5001u);
  EXPECT_GT(device.health().lost, 3000u);
}

TEST(PointerDevice, TwoThreads) {
  PointerDevice device;
  constexpr int kCount = 20'000;
  std::atomic<bool> sent{false};
  std::thread browser([&] {
    device.connected();
    for (int i = 0; i < kCount; ++i) {
      device.push(at(1e-6 * i));
      if (i % 500 == 0) std::this_thread::yield();
    }
    sent = true;
  });
  std::vector<DeviceSample> out;
  double last = -1.0;
  std::uint64_t received = 0;
  for (std::int64_t now = 0;; ++now) {
    out.clear();
    const bool last_look = sent;  // before the look: what comes after it cannot be missed
    device.poll(now, out);
    for (const DeviceSample& s : out) {
      ASSERT_GT(s.X_WD.p.x(), last);
      last = s.X_WD.p.x();
    }
    received += out.size();
    if (last_look && out.empty()) break;
    if (out.empty()) std::this_thread::yield();
  }
  browser.join();
  EXPECT_EQ(received, device.health().received);
  EXPECT_LE(received + device.health().lost, static_cast<std::uint64_t>(kCount));
}

}  // namespace pointer_device_test
}  // namespace filum
