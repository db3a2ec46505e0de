#include "devices/igtl_tracker.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "base/error.h"
#include "devices/igtl_stream.h"

namespace filum {
namespace igtl_tracker_test {

Pose pose_at(double x) {
  Pose X;
  X.p = Vec3(x, -0.02, 0.03);
  X.q = Quat(Eigen::AngleAxisd(0.7, Vec3(1, -2, 3).normalized()));
  return X;
}

/// Each message a millisecond later than the one before, unless a time is given.
std::vector<std::uint8_t> transform(const std::string& name, const Pose& X, std::int64_t time_us = 0) {
  static std::int64_t clock_us = 5'250'000;
  if (time_us == 0) time_us = clock_us += 1000;
  std::vector<std::uint8_t> bytes(kIgtlTransform);
  EXPECT_EQ(igtl_transform(name, X, time_us, bytes), kIgtlTransform);
  return bytes;
}

void put(std::vector<std::uint8_t>& bytes, std::size_t at, std::uint64_t v, int n) {
  for (int i = n - 1; i >= 0; --i, v >>= 8) bytes[at + static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(v);
}

/// With the body's size and checksum set right.
std::vector<std::uint8_t> sealed(std::vector<std::uint8_t> bytes) {
  put(bytes, 42, bytes.size() - kIgtlHeader, 8);
  put(bytes, 50, igtl_crc64(std::span(bytes).subspan(kIgtlHeader)), 8);
  return bytes;
}

/// A TDATA message of the named tools.
std::vector<std::uint8_t> tdata(const std::vector<std::string>& names) {
  std::vector<std::uint8_t> bytes = transform("Tracker", {});
  bytes.resize(kIgtlHeader);
  std::memset(bytes.data() + 2, 0, 12);
  std::memcpy(bytes.data() + 2, "TDATA", 5);
  for (std::size_t k = 0; k < names.size(); ++k) {
    const auto one = transform("x", pose_at(0.001 * static_cast<double>(k + 1)));
    std::vector<std::uint8_t> element(22, 0);
    std::memcpy(element.data(), names[k].data(), names[k].size());
    element.insert(element.end(), one.begin() + kIgtlHeader, one.end());
    bytes.insert(bytes.end(), element.begin(), element.end());
  }
  return sealed(bytes);
}

struct Fed {
  IgtlTracker tracker;
  std::vector<DeviceSample> samples;
  bool give(const std::vector<std::uint8_t>& bytes) { return tracker.feed(bytes, 1000, samples); }
};

TEST(IgtlTracker, ATransformIsAPoseInMetres) {
  Fed f;
  ASSERT_TRUE(f.give(transform("Tool1ToReference", pose_at(0.01), 5'250'000)));
  ASSERT_EQ(f.samples.size(), 1u);
  EXPECT_EQ(f.samples[0].tool, 1);
  EXPECT_LT((f.samples[0].X_WD.p - pose_at(0.01).p).norm(), 1e-8);
  EXPECT_GT(std::abs(f.samples[0].X_WD.q.dot(pose_at(0.01).q)), 1.0 - 1e-7);
  EXPECT_EQ(f.samples[0].device_time_us, 5'250'000 - 1 + 1);
}

TEST(IgtlTracker, ASenderWithoutTimeStampsHasTheHostsClock) {
  Fed f;
  auto bytes = transform("Tool0", pose_at(0.01));
  put(bytes, 34, 0, 8);
  for (const std::int64_t now : {700, 1700}) ASSERT_TRUE(f.tracker.feed(bytes, now, f.samples));
  ASSERT_EQ(f.samples.size(), 2u);
  EXPECT_EQ(f.samples[0].device_time_us, 700);
  EXPECT_EQ(f.samples[1].device_time_us, 1700);
}

TEST(IgtlTracker, AToolThatIsNotInTheMessageIsADropout) {
  Fed f;
  f.give(tdata({"Tool0", "tool1", "Stylus"}));
  ASSERT_EQ(f.samples.size(), 2u);
  f.give(tdata({"tool1"}));
  ASSERT_EQ(f.samples.size(), 3u);
  EXPECT_EQ(f.samples[2].tool, 1);
  f.give(tdata({}));
  EXPECT_EQ(f.samples.size(), 3u) << "nothing is held";
}

TEST(IgtlTracker, BytesMayComeInAnyPieces) {
  std::vector<std::uint8_t> stream;
  for (int k = 0; k < 20; ++k) {
    const auto one = k % 2 ? tdata({"Tool0", "Tool2"}) : transform("TOOL1", pose_at(0.001 * k));
    stream.insert(stream.end(), one.begin(), one.end());
  }
  for (const std::size_t piece : {1u, 7u, 57u, 58u, 59u, 4000u}) {
    Fed f;
    for (std::size_t at = 0; at < stream.size(); at += piece)
      ASSERT_TRUE(f.tracker.feed(std::span(stream).subspan(at, std::min(piece, stream.size() - at)), 0, f.samples));
    EXPECT_EQ(f.samples.size(), 30u) << piece;
  }
}

TEST(IgtlTracker, DamageIsCountedAndTheNextMessageIsRead) {
  Fed f;
  auto bad = transform("Tool0", pose_at(0.01));
  bad[80] ^= 4;
  ASSERT_TRUE(f.give(bad));
  EXPECT_TRUE(f.samples.empty());
  EXPECT_EQ(f.tracker.health().corrupt, 1u);
  f.give(transform("Tool0", pose_at(0.01)));
  EXPECT_EQ(f.samples.size(), 1u);
}

TEST(IgtlTracker, WhatIsNoRotationOrOutOfReachIsRefused) {
  Fed f;
  Pose far = pose_at(0.6);
  f.give(transform("Tool0", far));
  auto sheared = transform("Tool0", pose_at(0.01));
  put(sheared, kIgtlHeader, std::bit_cast<std::uint32_t>(3.0f), 4);
  f.give(sealed(sheared));
  auto nan = transform("Tool0", pose_at(0.01));
  put(nan, kIgtlHeader + 36, std::bit_cast<std::uint32_t>(std::numeric_limits<float>::quiet_NaN()), 4);
  f.give(sealed(nan));
  auto mirrored = transform("Tool0", Pose{});
  put(mirrored, kIgtlHeader, std::bit_cast<std::uint32_t>(-1.0f), 4);
  f.give(sealed(mirrored));
  EXPECT_TRUE(f.samples.empty());
  EXPECT_EQ(f.tracker.health().rejected, 4u);
}

TEST(IgtlTracker, LengthsThatLieAreSurvived) {
  Fed f;
  auto image = transform("Camera", {});
  std::memset(image.data() + 2, 0, 12);
  std::memcpy(image.data() + 2, "IMAGE", 5);
  image.resize(kIgtlHeader + 100'000);
  ASSERT_TRUE(f.give(sealed(image))) << "skipped without being kept";
  f.give(transform("Tool0", pose_at(0.01)));
  EXPECT_EQ(f.samples.size(), 1u);
  auto endless = transform("Tool0", {});
  put(endless, 42, ~0ull, 8);
  EXPECT_FALSE(f.give(endless)) << "the peer is dropped";
}

TEST(IgtlTracker, WhatIsSaidAgainIsNoPose) {
  Fed f;
  const auto first = transform("Tool0", pose_at(0.01)), second = transform("Tool0", pose_at(0.011));
  for (const auto& message : {first, second, first, second, second}) ASSERT_TRUE(f.give(message));
  EXPECT_EQ(f.samples.size(), 2u) << "a recording of the line played back";
  EXPECT_EQ(f.tracker.repeated(), 3u);
  ASSERT_TRUE(f.give(transform("Tool1", pose_at(0.01), 5'000'000))) << "each tool has its own newest";
  EXPECT_EQ(f.samples.size(), 3u);
  bool kept = true;
  for (int k = 0; k < 300 && kept; ++k) kept = f.give(first);
  EXPECT_FALSE(kept) << "a peer that only repeats itself is dropped";
  EXPECT_EQ(f.samples.size(), 3u);
}

TEST(IgtlTracker, AFloodIsReadInBoundedPieces) {
  IgtlStream stream("127.0.0.1", 0);
  IgtlTracker tracker("127.0.0.1", stream.port());
  std::vector<DeviceSample> samples;
  std::int64_t now = 0;
  for (; !stream.has_peer() && now < 2'000'000; now += 1000) {
    tracker.poll(now, samples);
    stream.send(0, pose_at(0.01), now + 1);
  }
  for (int k = 0; k < 5000; ++k) stream.send(0, pose_at(0.01), now + 2 + k);
  for (int k = 0; k < 50; ++k) {
    samples.clear();
    tracker.poll(now += 1000, samples);
    ASSERT_LE(samples.size(), 4096 / kIgtlTransform + 1) << "of some hundreds that wait";
  }
  EXPECT_GT(tracker.health().received, 1000u);
}

TEST(IgtlTracker, NoBytesCrashIt) {
  std::mt19937 random(5);
  for (int run = 0; run < 300; ++run) {
    Fed f;
    auto bytes = tdata({"Tool0", "Tool1"});
    for (int k = 0; k < 6; ++k) bytes[random() % bytes.size()] = static_cast<std::uint8_t>(random());
    f.give(bytes);
    for (const DeviceSample& s : f.samples) ASSERT_TRUE(s.X_WD.finite());
  }
}

TEST(IgtlTracker, AddressesAreNamedInTheRefusal) {
  EXPECT_THROW(IgtlTracker("nowhere", 18944), InputError);
  EXPECT_THROW(IgtlTracker("127.0.0.1", 0), InputError);
}

}  // namespace igtl_tracker_test
}  // namespace filum
