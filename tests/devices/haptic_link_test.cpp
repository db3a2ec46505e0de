// The UDP device over loopback, with a peer that behaves and peers that do not.
#include "devices/haptic_link.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cmath>

#include "base/error.h"

namespace filum {
namespace haptic_link_test {

/// A master's socket on loopback.
class Peer {
 public:
  explicit Peer(int port) : fd_(::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK, 0)) {
    to_.sin_family = AF_INET;
    to_.sin_port = htons(static_cast<std::uint16_t>(port));
    to_.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  }
  ~Peer() { ::close(fd_); }
  void send(const void* data, std::size_t size) {
    ASSERT_EQ(::sendto(fd_, data, size, 0, reinterpret_cast<const sockaddr*>(&to_), sizeof to_), static_cast<ssize_t>(size));
  }
  void send(filum_link_pose pose, std::uint32_t sequence, std::uint32_t session = 7) {
    pose.sequence = sequence;
    pose.session = session;
    pose.time_us = 1000 * sequence;
    std::uint8_t data[FILUM_LINK_POSE_SIZE];
    filum_link_put_pose(&pose, data);
    send(data, sizeof data);
  }
  bool receive(filum_link_force& force) {
    std::uint8_t data[256];
    const ssize_t n = ::recv(fd_, data, sizeof data, 0);
    return n > 0 && filum_link_get_force(data, static_cast<std::size_t>(n), &force);
  }

 private:
  int fd_;
  sockaddr_in to_{};
};

filum_link_pose somewhere(double x = 0.01) {
  Pose X;
  X.p = Vec3(x, -0.02, 0.03);
  X.q = Quat(Eigen::AngleAxisd(0.3, Vec3(1, 2, 3).normalized()));
  return link_pose(1, X, 0.12, 0.5, FILUM_LINK_TRACKED | FILUM_LINK_HAS_FORCE | FILUM_LINK_CLUTCH);
}

struct Ends {
  HapticLink link{"127.0.0.1", 0};
  Peer peer{link.port()};
  std::vector<DeviceSample> samples;
  std::int64_t now = 0;
  void poll(std::int64_t ms = 1) { link.poll(now += 1000 * ms, samples); }
};

TEST(HapticLink, APoseArrivesAndAForceGoesBack) {
  Ends e;
  EXPECT_EQ(e.link.health().state, DeviceState::waiting);
  e.peer.send(somewhere(), 1);
  e.poll();
  ASSERT_EQ(e.samples.size(), 1u);
  const DeviceSample& s = e.samples[0];
  EXPECT_EQ(s.tool, 1);
  EXPECT_LT((s.X_WD.p - Vec3(0.01, -0.02, 0.03)).norm(), 1e-7);
  EXPECT_NEAR(s.grip_angle, 0.12, 1e-6);
  EXPECT_NEAR(s.grip_force, 0.5, 1e-6);
  EXPECT_EQ(s.buttons, 1u);
  HandForces forces;
  forces.force[1] = Vec3(0.1, -2.0, 0.003);
  forces.valid[1] = true;
  e.link.render(e.now, forces);
  filum_link_force force;
  ASSERT_TRUE(e.peer.receive(force));
  EXPECT_EQ(force.tool, 1);
  EXPECT_EQ(force.flags, FILUM_LINK_VALID);
  EXPECT_EQ(force.answers, 1u);
  EXPECT_EQ(force.time_us, 1000u);
  EXPECT_EQ(force.force[1], -2'000'000);
  EXPECT_FALSE(e.peer.receive(force)) << "one packet for the one tool this peer moves";
}

TEST(HapticLink, SilenceMeansNoForceThenAnotherPeerMayCome) {
  Ends e;
  e.peer.send(somewhere(), 1);
  e.poll();
  e.poll(21);
  EXPECT_EQ(e.link.health().state, DeviceState::stale);
  HandForces forces;
  forces.force[1] = Vec3(1, 0, 0);
  forces.valid[1] = true;
  e.link.render(e.now, forces);
  filum_link_force force;
  ASSERT_TRUE(e.peer.receive(force));
  EXPECT_EQ(force.flags, 0);
  EXPECT_EQ(force.force[0], 0);
  Peer other(e.link.port());
  other.send(somewhere(), 1, 9);
  e.poll();
  EXPECT_EQ(e.samples.size(), 1u) << "the first peer may come back";
  e.poll(2001);
  EXPECT_EQ(e.link.health().state, DeviceState::lost);
  other.send(somewhere(), 2, 9);
  e.poll();
  EXPECT_EQ(e.link.health().state, DeviceState::live);
  EXPECT_EQ(e.samples.size(), 2u);
}

TEST(HapticLink, LossIsCountedAndReplayIsRefused) {
  Ends e;
  for (std::uint32_t k : {1u, 2u, 5u, 3u, 5u, 6u}) e.peer.send(somewhere(), k);
  e.poll();
  EXPECT_EQ(e.samples.size(), 4u);  // 1 2 5 6
  EXPECT_EQ(e.link.health().lost, 2u);
  EXPECT_EQ(e.link.counts().late, 2u);
  EXPECT_EQ(e.samples.back().device_time_us, 6000);
}

TEST(HapticLink, SequenceAndClockWrap) {
  Ends e;
  e.peer.send(somewhere(), 0xFFFFFFFFu);
  e.peer.send(somewhere(), 0u);
  e.poll();
  ASSERT_EQ(e.samples.size(), 2u);
  EXPECT_EQ(e.link.health().lost, 0u);
  EXPECT_EQ(e.samples[1].device_time_us - e.samples[0].device_time_us, 1000);
}

TEST(HapticLink, StrangersAndOtherSessionsAreRefused) {
  Ends e;
  Peer stranger(e.link.port());
  e.peer.send(somewhere(0.01), 1);
  stranger.send(somewhere(0.4), 2);   // same session, another port
  e.peer.send(somewhere(0.4), 3, 8);  // same port, another session
  e.poll();
  EXPECT_EQ(e.samples.size(), 1u);
  EXPECT_EQ(e.link.counts().strangers, 2u);
}

TEST(HapticLink, WhatCannotBeAHandIsRefused) {
  Ends e;
  filum_link_pose far = somewhere(0.7);
  filum_link_pose bent = somewhere();
  bent.quaternion[0] = 0;
  filum_link_pose strong = somewhere();
  strong.grip_force = 60'000'000;
  filum_link_pose unseen = somewhere();
  unseen.flags = 0;
  std::uint32_t k = 0;
  for (const filum_link_pose& pose : {far, bent, strong, unseen}) e.peer.send(pose, ++k);
  e.poll();
  EXPECT_TRUE(e.samples.empty()) << "out of sight is a dropout, never a held pose";
  EXPECT_EQ(e.link.counts().impossible, 3u);
}

TEST(HapticLink, DamagedPacketsAreCounted) {
  Ends e;
  std::uint8_t data[FILUM_LINK_POSE_SIZE + 8] = {};
  filum_link_pose pose = somewhere();
  filum_link_put_pose(&pose, data);
  e.peer.send(data, FILUM_LINK_POSE_SIZE - 1);
  e.peer.send(data, FILUM_LINK_POSE_SIZE + 1);
  e.peer.send(data, 0);
  for (int bit = 0; bit < 8 * static_cast<int>(FILUM_LINK_POSE_SIZE); bit += 11) {
    data[bit / 8] = static_cast<std::uint8_t>(data[bit / 8] ^ (1 << (bit % 8)));
    e.peer.send(data, FILUM_LINK_POSE_SIZE);
    data[bit / 8] = static_cast<std::uint8_t>(data[bit / 8] ^ (1 << (bit % 8)));
  }
  e.poll();
  EXPECT_TRUE(e.samples.empty());
  EXPECT_EQ(e.link.counts().malformed, 3u + (8u * FILUM_LINK_POSE_SIZE + 10u) / 11u);
}

TEST(HapticLink, AFloodIsReadInBoundedPieces) {
  Ends e;
  e.peer.send(somewhere(), 1);
  e.poll();
  for (std::uint32_t k = 2; k < 202; ++k) e.peer.send(somewhere(), k);
  e.poll();
  EXPECT_EQ(e.samples.size(), 1u + 64u);
  EXPECT_EQ(e.link.counts().floods, 1u);
}

TEST(HapticLink, AFloodOfStrangersCostsThePeerNothing) {
  Ends e;
  Peer stranger(e.link.port());
  e.peer.send(somewhere(), 1);
  e.poll();
  for (std::uint32_t k = 2; k < 102; ++k) {
    for (std::uint32_t n = 0; n < 200; ++n) stranger.send(somewhere(0.1), 1000 * k + n);
    e.peer.send(somewhere(), k);
    e.poll();
  }
  EXPECT_EQ(e.samples.size(), 101u);
  EXPECT_EQ(e.link.health().lost, 0u);
  EXPECT_EQ(e.link.counts().floods, 0u);
  for (const DeviceSample& s : e.samples) ASSERT_NEAR(s.X_WD.p.x(), 0.01, 1e-6);
}

TEST(HapticLink, AfterAFloodOfTheFirstOneThePortIsFreeAgain) {
  Ends e;
  Peer honest(e.link.port());
  for (std::uint32_t k = 0; k < 200; ++k) e.peer.send(somewhere(0.1), 7);  // one packet, again and again
  e.poll();
  EXPECT_EQ(e.samples.size(), 1u);
  EXPECT_EQ(e.link.counts().late, 63u);
  for (int k = 0; k < 5; ++k) e.poll();
  e.poll(2001);
  e.poll();
  honest.send(somewhere(), 1, 9);
  e.poll();
  EXPECT_EQ(e.link.health().state, DeviceState::live);
  EXPECT_NEAR(e.samples.back().X_WD.p.x(), 0.01, 1e-6);
}

TEST(HapticLink, TheAddressIsNamedInTheRefusal) {
  EXPECT_THROW(HapticLink("300.1.1.1", 0), InputError);
  EXPECT_THROW(HapticLink("127.0.0.1", 70000), InputError);
  HapticLink first("127.0.0.1", 0);
  EXPECT_THROW(HapticLink("127.0.0.1", first.port()), InputError) << "in use";
}

}  // namespace haptic_link_test
}  // namespace filum
