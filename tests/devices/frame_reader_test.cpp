#include "devices/frame_reader.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <random>
#include <vector>

namespace filum {
namespace frame_reader_test {

using Bytes = std::vector<std::uint8_t>;

bool same(const filum_frame& a, const filum_frame& b) {
  return a.type == b.type && a.size == b.size && a.device == b.device && a.sequence == b.sequence &&
         a.time_us == b.time_us && std::memcmp(a.payload, b.payload, a.size) == 0;
}

filum_frame grip_frame(std::uint16_t sequence, std::mt19937& random) {
  filum_frame frame{};
  const filum_grip grip{static_cast<std::uint8_t>(sequence % 2), 0,
                        static_cast<std::uint16_t>(random() & 0xFFF),
                        static_cast<std::uint16_t>(random() & 0xFFF)};
  filum_put_grip(&frame, &grip);
  frame.device = 7;
  frame.sequence = sequence;
  frame.time_us = 1000u * sequence;
  return frame;
}

filum_frame pose_frame(std::uint16_t sequence, std::mt19937& random) {
  filum_frame frame{};
  filum_pose pose{};
  pose.tool = 1;
  pose.flags = FILUM_POSE_TRACKED;
  for (std::int32_t& p : pose.position) p = static_cast<std::int32_t>(random() % 200000) - 100000;
  pose.quaternion[0] = 1 << 30;
  filum_put_pose(&frame, &pose);
  frame.device = 7;
  frame.sequence = sequence;
  frame.time_us = 1000u * sequence;
  return frame;
}

Bytes wire(const filum_frame& frame) {
  Bytes bytes(FILUM_MAX_WIRE);
  bytes.resize(filum_frame_encode(&frame, bytes.data()));
  return bytes;
}

std::vector<filum_frame> read_all(FrameReader& reader, const Bytes& bytes, std::size_t piece = 1u << 20) {
  std::vector<filum_frame> frames;
  for (std::size_t at = 0; at < bytes.size(); at += piece)
    reader.feed(std::span(bytes).subspan(at, std::min(piece, bytes.size() - at)),
                [&](const filum_frame& f) { frames.push_back(f); });
  return frames;
}

struct Stream {
  std::vector<filum_frame> frames;
  std::vector<std::size_t> starts;  // place of each frame's first byte
  Bytes bytes;
};

Stream stream_of(std::size_t n, std::uint32_t seed = 3) {
  std::mt19937 random(seed);
  Stream s;
  s.bytes.push_back(0);
  for (std::size_t i = 0; i < n; ++i) {
    s.frames.push_back(i % 3 == 2 ? pose_frame(static_cast<std::uint16_t>(i), random)
                                  : grip_frame(static_cast<std::uint16_t>(i), random));
    s.starts.push_back(s.bytes.size());
    const Bytes w = wire(s.frames.back());
    s.bytes.insert(s.bytes.end(), w.begin(), w.end());
  }
  return s;
}

TEST(Protocol, ChecksumHasItsCheckValue) {
  const char* text = "123456789";
  EXPECT_EQ(filum_crc16(reinterpret_cast<const std::uint8_t*>(text), 9), 0x29B1);
}

TEST(Protocol, CobsMatchesThePublishedExamples) {
  const std::pair<Bytes, Bytes> examples[] = {
      {{}, {1}},
      {{0}, {1, 1}},
      {{0, 0}, {1, 1, 1}},
      {{0x11, 0x22, 0, 0x33}, {3, 0x11, 0x22, 2, 0x33}},
      {{0x11, 0x22, 0x33, 0x44}, {5, 0x11, 0x22, 0x33, 0x44}},
      {{0x11, 0, 0, 0}, {2, 0x11, 1, 1, 1}},
  };
  for (const auto& [plain, coded] : examples) {
    Bytes out(plain.size() + 2);
    out.resize(filum_cobs_encode(plain.data(), plain.size(), out.data(), out.size()));
    EXPECT_EQ(out, coded);
  }
}

TEST(Protocol, CobsReturnsEveryLengthAndHoldsNoZero) {
  std::mt19937 random(1);
  for (std::size_t n = 0; n <= 600; ++n) {
    for (int zeros : {0, 1, 4, 1000}) {
      Bytes plain(n);
      for (auto& b : plain)
        b = static_cast<std::uint8_t>(
            zeros && random() % 8 < static_cast<unsigned>(zeros) ? 0 : 1 + random() % 255);
      Bytes coded(n + n / 254 + 1), back(n);
      coded.resize(filum_cobs_encode(plain.data(), n, coded.data(), coded.size()));
      ASSERT_GT(coded.size(), n);
      ASSERT_EQ(std::count(coded.begin(), coded.end(), 0), 0);
      std::size_t size = 0;
      ASSERT_TRUE(filum_cobs_decode(coded.data(), coded.size(), back.data(), back.size(), &size));
      ASSERT_EQ(size, n);
      ASSERT_EQ(back, plain);
    }
  }
}

TEST(Protocol, EveryTypeComesBackAsSent) {
  filum_frame f{};
  const filum_hello hello{{1, 2, 3}, 3, 4095, 4095, 1000, 0xDEADBEEF};
  filum_hello hello2;
  filum_put_hello(&f, &hello);
  EXPECT_EQ(wire(f).size(), 28u);
  ASSERT_TRUE(filum_get_hello(&f, &hello2));
  EXPECT_EQ(hello2.calibration, 0xDEADBEEFu);
  EXPECT_EQ(hello2.rate_hz, 1000);
  const filum_grip grip{2, FILUM_PEDAL | FILUM_FORCE_BROKEN, 65535, 1};
  filum_grip grip2;
  filum_put_grip(&f, &grip);
  EXPECT_EQ(wire(f).size(), 20u);
  ASSERT_TRUE(filum_get_grip(&f, &grip2));
  EXPECT_EQ(grip2.flags, grip.flags);
  EXPECT_EQ(grip2.angle, 65535);
  const filum_pose pose{0, 1, {-1, INT32_MIN, INT32_MAX}, {1 << 30, -(1 << 30), 0, -7}};
  filum_pose pose2;
  filum_put_pose(&f, &pose);
  EXPECT_EQ(wire(f).size(), 44u);
  ASSERT_TRUE(filum_get_pose(&f, &pose2));
  for (int i = 0; i < 3; ++i) EXPECT_EQ(pose2.position[i], pose.position[i]);
  for (int i = 0; i < 4; ++i) EXPECT_EQ(pose2.quaternion[i], pose.quaternion[i]);
  const filum_pong pong{123456789u, 4000000000u};
  filum_pong pong2;
  filum_put_pong(&f, &pong);
  EXPECT_EQ(wire(f).size(), 22u);
  ASSERT_TRUE(filum_get_pong(&f, &pong2));
  EXPECT_EQ(pong2.received_us, 4000000000u);
  filum_ping ping{5}, ping2;
  filum_put_ping(&f, &ping);
  EXPECT_EQ(wire(f).size(), 18u);
  ASSERT_TRUE(filum_get_ping(&f, &ping2));
  EXPECT_FALSE(filum_get_grip(&f, &grip2));
}

TEST(FrameReader, ReadsAStreamCutInPiecesOfAnySize) {
  const Stream s = stream_of(50);
  for (std::size_t piece = 1; piece < 90; ++piece) {
    FrameReader reader;
    const auto got = read_all(reader, s.bytes, piece);
    ASSERT_EQ(got.size(), s.frames.size()) << "pieces of " << piece;
    for (std::size_t i = 0; i < got.size(); ++i) ASSERT_TRUE(same(got[i], s.frames[i]));
    EXPECT_EQ(reader.counts().corrupt(), 0u);
  }
}

TEST(FrameReader, TruncationLosesOnlyTheFrameThatWasCut) {
  const Stream s = stream_of(9);
  for (std::size_t cut = s.starts[3]; cut < s.starts[4]; ++cut) {
    Bytes bytes(s.bytes.begin(), s.bytes.begin() + static_cast<std::ptrdiff_t>(cut));
    bytes.push_back(0);
    bytes.insert(bytes.end(), s.bytes.begin() + static_cast<std::ptrdiff_t>(s.starts[4]), s.bytes.end());
    FrameReader reader;
    const auto got = read_all(reader, bytes);
    const bool whole = cut + 1 == s.starts[4];  // only its closing zero was cut, and put back
    ASSERT_EQ(got.size(), whole ? 9u : 8u) << "cut at " << cut - s.starts[3];
    EXPECT_EQ(reader.counts().corrupt(), whole || cut == s.starts[3] ? 0u : 1u);
  }
}

TEST(FrameReader, EverySingleBitFlipIsCaught) {
  const Stream s = stream_of(6);
  for (std::size_t bit = 8 * s.starts[1]; bit < 8 * s.starts[4]; ++bit) {
    Bytes bytes = s.bytes;
    bytes[bit / 8] = static_cast<std::uint8_t>(bytes[bit / 8] ^ (1u << (bit % 8)));
    FrameReader reader;
    const auto got = read_all(reader, bytes);
    for (const filum_frame& f : got)
      ASSERT_TRUE(
          std::any_of(s.frames.begin(), s.frames.end(), [&](const filum_frame& g) { return same(f, g); }))
          << "bit " << bit;
    ASSERT_GE(got.size(), 4u) << "one flip may cost two frames, when it falls on the zero between them";
    ASSERT_LT(got.size(), 6u);
    ASSERT_GE(reader.counts().corrupt(), 1u);
  }
}

TEST(FrameReader, GarbageAtTheStartCostsNoFrameAndIsNotCounted) {
  Stream s = stream_of(5);
  Bytes bytes{0x55, 0xAA, 0x12, 0xFF};  // half a frame: the port was opened in the middle
  bytes.insert(bytes.end(), s.bytes.begin(), s.bytes.end());
  FrameReader reader;
  EXPECT_EQ(read_all(reader, bytes).size(), 5u);
  EXPECT_EQ(reader.counts().corrupt(), 0u);
}

TEST(FrameReader, ForeignDataGivesNoFrames) {
  std::string nmea;
  for (int i = 0; i < 2000; ++i)
    nmea += "$GPGGA,123519,4807.038,N,01131.000,E,1,08,0.9,545.4,M,46.9,M,,*47\r\n";
  FrameReader reader;
  EXPECT_TRUE(read_all(reader, Bytes(nmea.begin(), nmea.end())).empty());
  std::mt19937 random(5);
  Bytes noise(1'000'000);
  for (auto& b : noise) b = static_cast<std::uint8_t>(random());
  EXPECT_TRUE(read_all(reader, noise).empty());
  EXPECT_GT(reader.counts().corrupt(), 1000u);
}

TEST(FrameReader, TellsTheKindsOfDamageApart) {
  std::mt19937 random(2);
  const auto raw_wire = [](Bytes raw, bool good_crc) {
    const std::uint16_t crc =
        static_cast<std::uint16_t>(filum_crc16(raw.data(), raw.size()) ^ (good_crc ? 0 : 1));
    raw.push_back(static_cast<std::uint8_t>(crc & 0xFF));
    raw.push_back(static_cast<std::uint8_t>(crc >> 8));
    Bytes out(raw.size() + 3);
    out.resize(filum_cobs_encode(raw.data(), raw.size(), out.data(), out.size()));
    out.push_back(0);
    return out;
  };
  const auto counts = [](const Bytes& bytes) {
    FrameReader reader;
    read_all(reader, {0});
    read_all(reader, bytes);
    return reader.counts();
  };
  const Bytes grip{1, 2, 7, 0, 1, 0, 1, 2, 3, 4, /**/ 0, 0, 1, 1, 2, 2};
  Bytes version = grip, type = grip, longer = grip;
  version[0] = 2;
  type[1] = 99;
  longer.push_back(1);
  EXPECT_EQ(counts(raw_wire(grip, true)).good, 1u);
  EXPECT_EQ(counts(raw_wire(grip, false)).bad_crc, 1u);
  EXPECT_EQ(counts(raw_wire(version, true)).bad_version, 1u);
  EXPECT_EQ(counts(raw_wire(type, true)).bad_type, 1u);
  EXPECT_EQ(counts(raw_wire(longer, true)).bad_length, 1u);
  EXPECT_EQ(counts({9, 1, 0}).bad_cobs, 1u);
  EXPECT_EQ(counts(Bytes(3000, 1)).good, 0u);
  Bytes endless(3000, 1);
  endless.push_back(0);
  EXPECT_EQ(counts(endless).bad_length, 1u);
}

/// Damages a stretch of bytes in one of the ways lines do.
void damage(Bytes& bytes, std::size_t first, std::size_t last, std::mt19937& random) {
  const auto place = [&] { return static_cast<std::ptrdiff_t>(first + random() % (last - first)); };
  const int times = 1 + static_cast<int>(random() % 4);
  for (int i = 0; i < times; ++i) {
    const auto at = bytes.begin() + place();
    switch (random() % 5) {
      case 0:
        *at = static_cast<std::uint8_t>(*at ^ (1u << (random() % 8)));
        break;
      case 1:
        *at = static_cast<std::uint8_t>(random());
        break;
      case 2:
        bytes.erase(at);
        --last;
        break;
      case 3:
        bytes.insert(at, static_cast<std::uint8_t>(random()));
        ++last;
        break;
      case 4:
        for (auto b = at; b < at + 6 && b < bytes.begin() + static_cast<std::ptrdiff_t>(last); ++b)
          *b = static_cast<std::uint8_t>(random());
        break;
    }
  }
}

TEST(FrameReader, NoDamagedFrameIsEverTakenForGood) {
  const Stream s = stream_of(8);
  std::mt19937 random(20);
  std::uint64_t wrong = 0, caught = 0;
  constexpr int kTrials = 100'000;
  for (int trial = 0; trial < kTrials; ++trial) {
    Bytes bytes = s.bytes;
    const std::size_t victim = 1 + random() % 6;
    damage(bytes, s.starts[victim], s.starts[victim + 1], random);
    FrameReader reader;
    std::size_t sent = 0;
    for (const filum_frame& f : read_all(reader, bytes)) {
      while (sent < s.frames.size() && !same(f, s.frames[sent])) ++sent;
      if (sent++ >= s.frames.size()) ++wrong;
    }
    caught += reader.counts().corrupt() > 0;
    ASSERT_GE(reader.counts().good, 6u) << "damage spread beyond the neighbours";
  }
  std::printf("%d damaged streams: %llu with frames refused, %llu accepted frames that were not sent\n",
              kTrials, static_cast<unsigned long long>(caught), static_cast<unsigned long long>(wrong));
  EXPECT_EQ(wrong, 0u);
  EXPECT_GT(caught, 95'000u);
}

}  // namespace frame_reader_test
}  // namespace filum
