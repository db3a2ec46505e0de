// Streams of messages, damage and lengths that lie: igtl_tracker_test; against the library's classes: igtl_library_test.

#include "devices/igtl_message.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>

namespace filum {
namespace igtl_message_test {

using Bytes = std::vector<std::uint8_t>;

Pose known() { return {Vec3(0.012, -0.034, 0.056), Quat(Eigen::AngleAxisd(1.1, Vec3(3, -1, 2).normalized()))}; }

Bytes transform(std::string_view device, const Pose& X, std::int64_t time_us = 0) {
  Bytes out(kIgtlTransform);
  EXPECT_EQ(igtl_transform(device, X, time_us, out), out.size());
  return out;
}

/// Header and poses of a message.
struct Read {
  IgtlHeader header;
  bool known = false;
  IgtlBody body = IgtlBody::other;
  std::vector<IgtlPose> poses;
  explicit Read(const Bytes& message) {
    known = igtl_header(message, header);
    if (known) body = igtl_body(header, std::span(message).subspan(kIgtlHeader), [&](const IgtlPose& p) { poses.push_back(p); });
  }
};

void put(Bytes& b, std::size_t at, std::uint64_t value, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) b[at + i] = static_cast<std::uint8_t>(value >> 8 * (n - 1 - i));
}
double big_endian_float(const Bytes& b, std::size_t at) {
  return std::bit_cast<float>(std::uint32_t{b[at]} << 24 | std::uint32_t{b[at + 1]} << 16 | std::uint32_t{b[at + 2]} << 8 | b[at + 3]);
}

/// Another body under this header, with its length and checksum put right.
Bytes with_body(const Bytes& message, const Bytes& body, int version = 1) {
  Bytes out(message.begin(), message.begin() + kIgtlHeader);
  put(out, 0, static_cast<std::uint64_t>(version), 2);
  put(out, 42, body.size(), 8);
  put(out, 50, igtl_crc64(body), 8);
  out.insert(out.end(), body.begin(), body.end());
  return out;
}
Bytes body_of(const Bytes& message) { return {message.begin() + kIgtlHeader, message.end()}; }

/// The catalogue's check value of CRC-64/ECMA-182.
TEST(IgtlMessage, ChecksumIsEcma182) {
  const std::string_view text = "123456789";
  const Bytes bytes(text.begin(), text.end());
  EXPECT_EQ(igtl_crc64(bytes), 0x6C40DF5F0B497347u);
}

TEST(IgtlMessage, BytesLieWhereTheProtocolPutsThem) {
  const Bytes m = transform("Tool1", known(), 2'500'000);
  const Mat3 R = known().q.toRotationMatrix();
  EXPECT_EQ(Bytes(m.begin(), m.begin() + 2), (Bytes{0, 1}));
  EXPECT_STREQ(reinterpret_cast<const char*>(m.data()) + 2, "TRANSFORM");
  EXPECT_STREQ(reinterpret_cast<const char*>(m.data()) + 14, "Tool1");
  EXPECT_EQ(Bytes(m.begin() + 34, m.begin() + 42), (Bytes{0, 0, 0, 2, 0x80, 0, 0, 0})) << "2.5 s as 32.32";
  EXPECT_EQ(m[49], 48);
  for (int i = 0; i < 9; ++i) EXPECT_NEAR(big_endian_float(m, kIgtlHeader + 4 * static_cast<std::size_t>(i)), R(i % 3, i / 3), 1e-7) << "columns first";
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(big_endian_float(m, kIgtlHeader + 36 + 4 * static_cast<std::size_t>(i)), 1e3 * known().p[i], 1e-5) << "millimetres";
}

TEST(IgtlMessage, ATransformReadsBackAsWritten) {
  const Bytes m = transform("Tool1", known(), 1'700'000'000'123'456);
  const Read r(m);
  ASSERT_TRUE(r.known);
  EXPECT_EQ(r.header.version, 1);
  EXPECT_EQ(r.header.type, "TRANSFORM");
  EXPECT_EQ(r.header.device, "Tool1");
  EXPECT_NEAR(static_cast<double>(r.header.time_us - 1'700'000'000'123'456), 0.0, 1.0) << "a fraction of 2^-32 is cut off on the way";
  ASSERT_EQ(r.body, IgtlBody::poses);
  ASSERT_EQ(r.poses.size(), 1u);
  EXPECT_TRUE(r.poses[0].sound);
  EXPECT_EQ(r.poses[0].name, "Tool1");
  EXPECT_LT((r.poses[0].X.p - known().p).norm(), 1e-8);  // floats
  EXPECT_LT(r.poses[0].X.q.angularDistance(known().q), 1e-6);
}

TEST(IgtlMessage, NamesFillTheirFieldAndNoMore) {
  const std::string longer(30, 'x');
  Bytes m = transform(longer, known());
  EXPECT_EQ(Read(m).header.device, longer.substr(0, 19)) << "the last byte ends it";
  m[33] = 'y';  // from others that fill it to the end
  EXPECT_EQ(Read(m).header.device, longer.substr(0, 19) + "y");
}

TEST(IgtlMessage, HeadersOfOtherVersionsAndShortOnesAreNone) {
  Bytes m = transform("Tool0", known());
  IgtlHeader h;
  for (const int version : {0, 1, 2, 3, 4, 256}) {
    put(m, 0, static_cast<std::uint64_t>(version), 2);
    EXPECT_EQ(igtl_header(m, h), version >= 1 && version <= 3) << version;
  }
  put(m, 0, 1, 2);
  EXPECT_FALSE(igtl_header(std::span(m).first(kIgtlHeader - 1), h));
  m[2] = 0;
  EXPECT_FALSE(igtl_header(m, h)) << "of no type";
}

/// Version 2: extended header (12 bytes and more), content, metadata header and metadata.
TEST(IgtlMessage, ExtendedHeaderAndMetadataAreCutOff) {
  const Bytes first = transform("Tool0", known()), content = body_of(first);
  Bytes body(14, 0xee);  // two bytes more than we know of
  put(body, 0, 14, 2);
  put(body, 2, 3, 2);   // metadata header
  put(body, 4, 5, 4);   // metadata
  body.insert(body.end(), content.begin(), content.end());
  body.insert(body.end(), 8, 0xdd);
  const Read r(with_body(first, body, 2));
  ASSERT_EQ(r.body, IgtlBody::poses);
  EXPECT_LT((r.poses.at(0).X.p - known().p).norm(), 1e-8);
  EXPECT_EQ(Read(with_body(first, body, 1)).body, IgtlBody::damaged) << "in version 1 all of it is content";
  for (const auto& [at, value, n] : {std::tuple{0, 11, 2}, {0, 71, 2}, {2, 57, 2}, {4, 54, 4}}) {
    Bytes bad = body;
    put(bad, static_cast<std::size_t>(at), static_cast<std::uint64_t>(value), static_cast<std::size_t>(n));
    EXPECT_EQ(Read(with_body(first, bad, 2)).body, IgtlBody::damaged) << at << " " << value;
  }
  put(body, 0, 11, 2);
  put(body, 4, 8, 4);
  EXPECT_EQ(Read(with_body(first, body, 2)).body, IgtlBody::damaged) << "what is left is as long as a pose, but the header is cut short";
  EXPECT_EQ(Read(with_body(first, Bytes(11, 0), 2)).body, IgtlBody::damaged);
}

TEST(IgtlMessage, EveryToolOfATrackingMessageIsTaken) {
  const Bytes first = transform("Tracker", known()), content = body_of(first);
  Bytes body;
  for (const char* name : {"Tool0", "Tool2"}) {
    Bytes element(22, 0);
    std::memcpy(element.data(), name, std::strlen(name));
    body.insert(body.end(), element.begin(), element.end());
    body.insert(body.end(), content.begin(), content.end());
  }
  Bytes head = first;
  std::memcpy(head.data() + 2, "TDATA\0\0\0\0", 10);
  const Bytes message = with_body(head, body);
  const Read r(message);
  ASSERT_EQ(r.poses.size(), 2u);
  EXPECT_EQ(r.poses[0].name, "Tool0");
  EXPECT_EQ(r.poses[1].name, "Tool2");
  EXPECT_LT((r.poses[1].X.p - known().p).norm(), 1e-8);
  body.pop_back();
  EXPECT_EQ(Read(with_body(head, body)).body, IgtlBody::damaged);
  std::memcpy(head.data() + 2, "STATUS", 7);
  EXPECT_EQ(Read(with_body(head, body)).body, IgtlBody::other);
}

TEST(IgtlMessage, AMirrorIsNoRotation) {
  const Bytes first = transform("Tool0", known());
  Bytes body = body_of(first);
  for (const std::size_t at : {0, 4, 8}) body[at] = static_cast<std::uint8_t>(body[at] ^ 0x80);  // x axis turned about
  EXPECT_FALSE(Read(with_body(first, body)).poses.at(0).sound);
}

TEST(IgtlMessage, NothingIsWrittenWhereThereIsNoRoom) {
  Bytes out(kIgtlTransform - 1, 7);
  EXPECT_EQ(igtl_transform("Tool0", known(), 0, out), 0u);
  EXPECT_EQ(out, Bytes(kIgtlTransform - 1, 7));
}

}  // namespace igtl_message_test
}  // namespace filum
