#include "devices/igtl_stream.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cstring>

#include "devices/igtl_message.h"
#include "devices/igtl_tracker.h"
#include "tests/refusal.h"

namespace filum {
namespace igtl_stream_test {

Pose known() {
  Pose X;
  X.p = Vec3(0.012, -0.034, 0.056);
  X.q = Quat(Eigen::AngleAxisd(1.1, Vec3(3, -1, 2).normalized()));
  return X;
}

/// A program that listens to the stream, by plain sockets.
class Peer {
 public:
  explicit Peer(int port) : fd_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in there{};
    there.sin_family = AF_INET;
    there.sin_port = htons(static_cast<std::uint16_t>(port));
    there.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(::connect(fd_, reinterpret_cast<const sockaddr*>(&there), sizeof there), 0);
  }
  ~Peer() { leave(); }
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;

  void leave() {
    if (fd_ >= 0) ::close(fd_);
    fd_ = -1;
  }
  void say(const std::string& text) { EXPECT_EQ(::send(fd_, text.data(), text.size(), MSG_NOSIGNAL), static_cast<ssize_t>(text.size())); }
  /// `n` bytes, or fewer if the stream hung up before or nothing comes for long.
  std::string hear(std::size_t n) {
    std::string all;
    char part[4096];
    while (all.size() < n && something()) {
      const ssize_t got = ::recv(fd_, part, std::min(sizeof part, n - all.size()), 0);
      if (got <= 0) break;
      all.append(part, static_cast<std::size_t>(got));
    }
    return all;
  }
  /// The stream has closed the line and nothing is left to be read.
  bool turned_away() {
    char byte;
    return something() && ::recv(fd_, &byte, 1, 0) <= 0;
  }

 private:
  bool something() {
    pollfd wait{fd_, POLLIN, 0};
    return ::poll(&wait, 1, 20'000) == 1;
  }
  int fd_;
};

/// Until the stream has taken a peer that is connected already.
void until_taken(IgtlStream& stream) {
  for (int k = 0; k < 10'000 && !stream.has_peer(); ++k) {
    stream.send(0, known(), k);
    if (!stream.has_peer()) ::usleep(1000);
  }
  ASSERT_TRUE(stream.has_peer());
}

std::uint64_t big_endian(const std::string& bytes, std::size_t at, int n) {
  std::uint64_t v = 0;
  for (int i = 0; i < n; ++i) v = v << 8 | static_cast<std::uint8_t>(bytes.at(at + static_cast<std::size_t>(i)));
  return v;
}

double number(const std::string& message, int i) {
  return std::bit_cast<float>(static_cast<std::uint32_t>(big_endian(message, 58 + 4 * static_cast<std::size_t>(i), 4)));
}

std::string text_at(const std::string& message, std::size_t at) { return {message.c_str() + std::min(at, message.size())}; }

InputError refusal(const std::string& address, int port) { return refusal_by([&] { IgtlStream stream(address, port); }); }

TEST(IgtlStream, PortZeroTakesOneThatIsFree) {
  const IgtlStream first("127.0.0.1", 0), second("127.0.0.1", 0);
  EXPECT_GT(first.port(), 0);
  EXPECT_LE(first.port(), 65535);
  EXPECT_NE(first.port(), second.port());
}

TEST(IgtlStream, AnAddressThatIsNoneIsNamed) {
  for (const auto& [address, port] : {std::pair("nowhere", 0), std::pair("", 0), std::pair("127.0.0.1", -1), std::pair("127.0.0.1", 65536)}) {
    const InputError error = refusal(address, port);
    EXPECT_EQ(error.file, "OpenIGTLink stream");
    EXPECT_EQ(error.field, "address");
    EXPECT_EQ(error.value, std::string(address) + ":" + std::to_string(port));
    EXPECT_EQ(error.expected, "an IPv4 address of this machine and a port");
  }
}

TEST(IgtlStream, APortInUseIsNamedAndFreeAgainAfterwards) {
  int port = 0;
  {
    const IgtlStream first("127.0.0.1", 0);
    port = first.port();
    const InputError error = refusal("127.0.0.1", port);
    EXPECT_EQ(error.value, "127.0.0.1:" + std::to_string(port));
    EXPECT_NE(error.expected.find("a port that is free"), std::string::npos) << error.what();
  }
  EXPECT_EQ(IgtlStream("127.0.0.1", port).port(), port);
}

TEST(IgtlStream, WithoutAPeerNothingIsSentAndNothingCountsAsDropped) {
  IgtlStream stream("127.0.0.1", 0);
  for (int k = 0; k < 10; ++k) stream.send(0, known(), k);
  EXPECT_FALSE(stream.has_peer());
  EXPECT_EQ(stream.sent(), 0u);
  EXPECT_EQ(stream.dropped(), 0u);
}

/// Read by hand, as the protocol says; the library's own classes read it in igtl_library_test.
TEST(IgtlStream, APoseIsATransformInMillimetresColumnByColumn) {
  IgtlStream stream("127.0.0.1", 0);
  Peer peer(stream.port());
  until_taken(stream);
  ASSERT_EQ(peer.hear(kIgtlTransform).size(), kIgtlTransform);
  stream.send(1, known(), 7'250'000);
  const std::string message = peer.hear(kIgtlTransform);
  ASSERT_EQ(message.size(), 106u);
  EXPECT_EQ(text_at(message, 2), "TRANSFORM");
  EXPECT_EQ(text_at(message, 14), "Tool1");
  EXPECT_EQ(big_endian(message, 34, 4), 7u) << "seconds";
  EXPECT_NEAR(static_cast<double>(big_endian(message, 38, 4)) / 4294967296.0, 0.25, 1e-6);
  EXPECT_EQ(big_endian(message, 42, 8), 48u);
  const Mat3 R = known().q.toRotationMatrix();
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r) EXPECT_NEAR(number(message, 3 * c + r), R(r, c), 1e-6) << r << " " << c;
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(number(message, 9 + i), 1e3 * known().p[i], 1e-5) << i;
}

TEST(IgtlStream, EachToolHasItsName) {
  IgtlStream stream("127.0.0.1", 0);
  Peer peer(stream.port());
  until_taken(stream);
  for (int tool = 0; tool < 3; ++tool) stream.send(tool, known(), tool);
  const std::string all = peer.hear(4 * kIgtlTransform);
  ASSERT_EQ(all.size(), 4 * kIgtlTransform);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(text_at(all, (k + 1) * kIgtlTransform + 14), "Tool" + std::to_string(k));
  EXPECT_EQ(stream.sent(), 4u);
  EXPECT_EQ(stream.dropped(), 0u);
}

TEST(IgtlStream, WhatAPeerSaysIsReadAndNotUsed) {
  IgtlStream stream("127.0.0.1", 0);
  Peer peer(stream.port());
  until_taken(stream);
  peer.say(std::string(3000, 'x'));
  for (int k = 0; k < 20; ++k) stream.send(0, known(), k);
  EXPECT_TRUE(stream.has_peer());
  EXPECT_EQ(peer.hear(21 * kIgtlTransform).size(), 21 * kIgtlTransform);
}

TEST(IgtlStream, OnePeerHearsTheToolsAndASecondIsTurnedAway) {
  IgtlStream stream("127.0.0.1", 0);
  IgtlTracker first("127.0.0.1", stream.port()), second("127.0.0.1", stream.port());
  std::vector<DeviceSample> heard, other;
  std::int64_t now = 0;
  for (int k = 0; k < 2000 && heard.size() < 50; ++k, now += 1000) {
    first.poll(now, heard);
    if (stream.has_peer()) second.poll(now, other);
    stream.send(2, known(), now);
  }
  ASSERT_GE(heard.size(), 50u);
  EXPECT_EQ(heard[0].tool, 2);
  EXPECT_LT((heard[0].X_WD.p - known().p).norm(), 1e-8);
  EXPECT_EQ(first.health().state, DeviceState::live);
  EXPECT_TRUE(other.empty());
}

/// 3D Slicer that is told to connect anew does so between two poses.
TEST(IgtlStream, APeerThatLeavesMakesRoomForTheNextAtOnce) {
  IgtlStream stream("127.0.0.1", 0);
  Peer first(stream.port());
  until_taken(stream);
  first.leave();
  Peer second(stream.port());
  stream.send(0, known(), 1);
  until_taken(stream);
  EXPECT_EQ(second.hear(kIgtlTransform).size(), kIgtlTransform) << "not turned away for one that has gone";
  Peer third(stream.port());
  for (int k = 0; k < 5; ++k) stream.send(0, known(), 2 + k);
  EXPECT_TRUE(third.turned_away()) << "while the second is there";
  EXPECT_TRUE(stream.has_peer());
}

TEST(IgtlStream, APeerThatReadsNothingDoesNotStopItAndGetsWholeMessagesOnly) {
  IgtlStream stream("127.0.0.1", 0);
  Peer silent(stream.port());
  until_taken(stream);
  std::int64_t k = 0;
  for (; k < 200'000 && stream.dropped() == 0; ++k) stream.send(1, known(), k);
  ASSERT_GT(stream.dropped(), 0u);
  const std::uint64_t sent = stream.sent();
  for (std::uint64_t n = 0; n < sent; ++n) {
    const std::string message = silent.hear(kIgtlTransform);
    ASSERT_EQ(message.size(), kIgtlTransform) << n << " of " << sent;
    ASSERT_EQ(text_at(message, 2), "TRANSFORM") << n;
  }
  stream.send(2, known(), k);
  if (stream.has_peer()) {
    EXPECT_EQ(text_at(silent.hear(kIgtlTransform), 14), "Tool2") << "the next one begins where the last one ended";
  } else {
    EXPECT_LT(silent.hear(kIgtlTransform).size(), kIgtlTransform) << "half a message ends the line";
  }
}

}  // namespace igtl_stream_test
}  // namespace filum
