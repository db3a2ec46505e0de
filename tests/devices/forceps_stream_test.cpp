#include "devices/forceps_stream.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

namespace filum {
namespace forceps_stream_test {

ForcepsCalibration calibration() {
  return ForcepsCalibration::load(std::string(FILUM_SOURCE_DIR) + "/models/forceps/default.yaml");
}

/// Sends frames as a handle would and keeps what the stream made of them.
struct Link {
  ForcepsStream stream{calibration()};
  std::vector<DeviceSample> samples;
  std::int64_t now_us = 0;

  void send(filum_frame frame, std::uint16_t sequence, std::uint32_t time_us, std::uint16_t device = 1) {
    frame.sequence = sequence;
    frame.time_us = time_us;
    frame.device = device;
    std::uint8_t wire[FILUM_MAX_WIRE];
    const std::size_t n = filum_frame_encode(&frame, wire);
    stream.feed(std::span(wire, n), now_us, samples);
  }
};

filum_frame grip(int tool = 0, std::uint8_t flags = 0, std::uint16_t angle = 1200,
                 std::uint16_t force = 500) {
  filum_frame frame{};
  const filum_grip g{static_cast<std::uint8_t>(tool), flags, angle, force};
  filum_put_grip(&frame, &g);
  return frame;
}

filum_frame pose(int tool, const Pose& X) {
  filum_frame frame{};
  const filum_pose p = wire_pose(tool, X);
  filum_put_pose(&frame, &p);
  return frame;
}

TEST(ForcepsStream, ConvertsAndKeepsTheRawCounts) {
  Link link;
  link.now_us = 77;
  link.send(grip(1, FILUM_PEDAL | FILUM_BUTTON_NEXT, 1200, 500), 0, 5000);
  ASSERT_EQ(link.samples.size(), 1u);
  const DeviceSample& s = link.samples[0];
  EXPECT_EQ(s.tool, 1);
  EXPECT_TRUE(s.has_grip_angle && s.has_grip_force);
  EXPECT_FALSE(s.has_pose);
  EXPECT_EQ(s.raw_angle, 1200);
  EXPECT_EQ(s.raw_force, 500);
  EXPECT_EQ(s.grip_angle, calibration().angle(1200));
  EXPECT_EQ(s.grip_force, calibration().force(500));
  EXPECT_EQ(s.buttons, 5u);
  EXPECT_EQ(s.host_time_us, 77);
  EXPECT_EQ(s.device_time_us, 5000);
}

TEST(ForcepsStream, ABrokenWireIsNoValueButItsCountIsKept) {
  Link link;
  link.send(grip(0, FILUM_FORCE_BROKEN, 900, 4095), 0, 0);
  link.send(grip(0, FILUM_ANGLE_BROKEN, 4095, 300), 1, 1000);
  link.send(grip(0, FILUM_NO_FORCE, 900, 0), 2, 2000);
  ASSERT_EQ(link.samples.size(), 3u);
  EXPECT_FALSE(link.samples[0].has_grip_force);
  EXPECT_EQ(link.samples[0].raw_force, 4095);
  EXPECT_FALSE(link.samples[1].has_grip_angle);
  EXPECT_TRUE(link.samples[1].has_grip_force);
  EXPECT_FALSE(link.samples[2].has_grip_force);
}

TEST(ForcepsStream, APoseArrivesToATenthOfAMicrometre) {
  Link link;
  const Pose X{{1.23456789e-2, -0.1, 0.0}, Quat(Eigen::AngleAxisd(1.1, Vec3(1, -2, 3).normalized()))};
  link.send(pose(2, X), 0, 0);
  ASSERT_EQ(link.samples.size(), 1u);
  EXPECT_TRUE(link.samples[0].has_pose);
  EXPECT_LE((link.samples[0].X_WD.p - X.p).cwiseAbs().maxCoeff(), 0.5001e-7);
  EXPECT_LT(link.samples[0].X_WD.q.angularDistance(X.q), 1e-7);
}

TEST(ForcepsStream, AnImpossiblePoseIsRejectedAndAnUntrackedOneIsSilent) {
  Link link;
  link.send(pose(0, {{0.51, 0, 0}, Quat::Identity()}), 0, 0);      // out of reach
  link.send(pose(0, {{0, 0, 0}, Quat(0.5, 0.1, 0, 0)}), 1, 1000);  // no unit quaternion
  filum_frame hidden{};
  filum_pose p = wire_pose(0, {});
  p.flags = 0;
  filum_put_pose(&hidden, &p);
  link.send(hidden, 2, 2000);
  filum_frame wrong_tool = grip();
  wrong_tool.payload[0] = 9;
  link.send(wrong_tool, 3, 3000);
  EXPECT_TRUE(link.samples.empty());
  EXPECT_EQ(link.stream.rejected(), 3u);
  EXPECT_EQ(link.stream.lost(), 0u);
}

TEST(ForcepsStream, GapsAreCountedAcrossTheWrapAndNeverFilledIn) {
  Link link;
  std::uint64_t sent = 0, dropped = 0;
  std::uint32_t sequence = 65000, time = 4'294'000'000u;
  for (int i = 0; i < 3000; ++i, ++sequence, time += 1000) {
    if (i > 0 && i % 7 == 0) {
      ++dropped;
      continue;
    }
    link.send(grip(), static_cast<std::uint16_t>(sequence), time);
    ++sent;
  }
  EXPECT_EQ(link.stream.lost(), dropped);
  EXPECT_EQ(link.samples.size(), sent);
  for (std::size_t i = 1; i < link.samples.size(); ++i) {
    const auto step = link.samples[i].sequence - link.samples[i - 1].sequence;
    ASSERT_EQ(link.samples[i].device_time_us - link.samples[i - 1].device_time_us, 1000LL * step);
  }
}

TEST(ForcepsStream, RepeatedAndLateFramesAreRefused) {
  Link link;
  link.send(grip(), 10, 0);
  link.send(grip(), 10, 0);
  link.send(grip(), 12, 2000);
  link.send(grip(), 11, 1000);
  EXPECT_EQ(link.samples.size(), 2u);
  EXPECT_EQ(link.stream.rejected(), 2u);
  EXPECT_EQ(link.stream.lost(), 1u);
}

/// A handle that also answers pings, 1 ms apart, its clock ahead of the host's by `offset_us`.
void pongs(Link& link, std::uint16_t first, int n, std::int64_t offset_us) {
  for (int i = 0; i < n; ++i, link.now_us += 1000) {
    filum_frame frame{};
    const filum_pong p{static_cast<std::uint32_t>(link.now_us - 400), static_cast<std::uint32_t>(link.now_us - 200 + offset_us)};
    filum_put_pong(&frame, &p);
    link.send(frame, static_cast<std::uint16_t>(first + i), static_cast<std::uint32_t>(link.now_us - 100 + offset_us));
  }
}

TEST(ForcepsStream, AHandleThatStartsAgainHasItsClockLearntAnew) {
  for (const int last : {100, 600, 32000, 33000, 65000}) {
    SCOPED_TRACE(last);
    Link link;
    link.now_us = 50'000'000;
    pongs(link, static_cast<std::uint16_t>(last - 99), 100, 900'000'000);
    ASSERT_EQ(link.stream.clock().offset_us(), 900'000'000);
    ASSERT_TRUE(link.stream.drift().known());
    filum_frame hello{};
    const filum_hello h{{1, 2, 3}, 3, 4095, 4095, 1000, 9};
    filum_put_hello(&hello, &h);
    link.send(hello, 0, 100);
    EXPECT_FALSE(link.stream.clock().known());
    EXPECT_FALSE(link.stream.drift().known());
    pongs(link, 1, 20, -40'000'000);
    EXPECT_EQ(link.stream.clock().offset_us(), -40'000'000);
    EXPECT_NEAR(link.stream.drift().at(link.now_us).offset_us, -40e6, 1.0);
    EXPECT_EQ(link.stream.rejected(), 0u);
  }
}

TEST(ForcepsStream, AWildSequenceNumberLeavesTheClockAlone) {
  Link link;
  link.now_us = 1'000'000;
  const std::int64_t ahead = (std::int64_t{1} << 32) - 1'050'000;  // its 32 bits wrap half way
  pongs(link, 1, 100, ahead);
  const std::int64_t offset = link.stream.clock().offset_us();
  link.send(grip(), 20000, static_cast<std::uint32_t>(link.now_us + ahead));  // a damaged frame that got through
  pongs(link, 101, 100, ahead);
  EXPECT_LT(link.stream.rejected(), 10u);
  EXPECT_EQ(link.stream.clock().offset_us(), offset);
  EXPECT_NEAR(link.stream.drift().at(link.now_us).drift_ppm, 0.0, 1.0);
}

TEST(ForcepsStream, AStartThatNobodyHeardOfIsFoundOutByTheClocksLeap) {
  Link link;
  link.now_us = 1'000'000;
  pongs(link, 1000, 100, 2'400'000'000);  // after 40 minutes half a turn of the clock is behind it: zero seems ahead
  pongs(link, 5, 40, 0);
  ASSERT_TRUE(link.stream.clock().known());
  EXPECT_EQ(link.stream.clock().offset_us(), 0);
  EXPECT_NEAR(link.stream.drift().at(link.now_us).drift_ppm, 0.0, 1.0);
}

TEST(ForcepsStream, ARestartedHandleIsNoLoss) {
  Link link;
  for (std::uint16_t i = 0; i < 100; ++i)
    link.send(grip(), static_cast<std::uint16_t>(500 + i), 900'000'000u + 1000u * i);
  filum_frame hello{};
  const filum_hello h{{1, 2, 3}, 3, 4095, 4095, 1000, 9};
  filum_put_hello(&hello, &h);
  link.send(hello, 0, 100);
  for (std::uint16_t i = 1; i < 100; ++i) link.send(grip(), i, 1000u * i);
  EXPECT_EQ(link.samples.size(), 199u);
  EXPECT_EQ(link.stream.lost(), 0u);
  EXPECT_EQ(link.stream.rejected(), 0u);
  EXPECT_TRUE(link.stream.calibration_differs());
}

TEST(ForcepsStream, AClockThatRunsBackIsARestartToo) {
  Link link;
  link.send(grip(), 40000, 900'000'000u);
  link.send(grip(), 3, 5000u);  // the hello was lost
  link.send(grip(), 4, 6000u);
  EXPECT_EQ(link.samples.size(), 3u);
  EXPECT_EQ(link.stream.lost(), 0u);
}

TEST(ForcepsStream, OneWildSequenceNumberDoesNotSilenceTheLink) {
  Link link;
  link.send(grip(), 1, 1000);
  link.send(grip(), 20000, 2000);  // a damaged frame that got through
  for (std::uint16_t i = 3; i < 100; ++i) link.send(grip(), i, 1000u * i);
  EXPECT_GT(link.samples.size(), 85u);
  EXPECT_LT(link.stream.rejected(), 10u);
}

TEST(ForcepsStream, DevicesOnOneLinkAreCountedApart) {
  Link link;
  for (std::uint16_t i = 0; i < 50; ++i) {
    link.send(grip(0), i, 1000u * i, 1);
    link.send(grip(1), static_cast<std::uint16_t>(30000 + i), 77'000'000u + 1000u * i, 2);
  }
  EXPECT_EQ(link.samples.size(), 100u);
  EXPECT_EQ(link.stream.lost(), 0u);
}

TEST(ForcepsStream, DevicesThatFellSilentGiveUpTheirPlace) {
  Link link;
  for (std::uint16_t device = 1; device <= 20; ++device) {
    link.now_us += 2'000'000;
    link.send(grip(), 0, 0, device);
  }
  EXPECT_EQ(link.samples.size(), 20u);
  for (std::uint16_t device = 30; device < 40; ++device)
    link.send(grip(), 0, 0, device);  // all at once: too many
  EXPECT_LT(link.samples.size(), 25u);
  EXPECT_GT(link.stream.rejected(), 5u);
}

TEST(ForcepsStream, PongsGiveTheOffsetOfTheClock) {
  Link link;
  const std::int64_t offset = 3'000'000'000;  // device minus host [us], so that its 32 bits wrap
  link.now_us = 4'294'900'000;                // the host's 32 bits wrap as well
  for (std::uint16_t i = 0; i < 200; ++i, link.now_us += 1000) {
    filum_frame frame{};
    const filum_pong p{static_cast<std::uint32_t>(link.now_us - 600),
                       static_cast<std::uint32_t>(link.now_us - 300 + offset)};
    filum_put_pong(&frame, &p);
    link.send(frame, i, static_cast<std::uint32_t>(link.now_us - 200 + offset));
  }
  ASSERT_TRUE(link.stream.clock().known());
  // The device's own 64-bit time starts at its first frame, so the offset is known modulo 2^32 us.
  EXPECT_EQ((link.stream.clock().offset_us() - offset) % (std::int64_t{1} << 32), 0);
}

}  // namespace forceps_stream_test
}  // namespace filum
