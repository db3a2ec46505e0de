#include "devices/igtl_message.h"

#include <bit>
#include <cmath>
#include <cstring>

namespace filum {
namespace {

constexpr std::uint64_t kPolynomial = 0x42F0E1EBA9EA3693u;  // ECMA-182
constexpr double kReach = 0.5;                              // [m]

constexpr std::array<std::uint64_t, 256> make_table() {
  std::array<std::uint64_t, 256> table{};
  for (std::uint64_t i = 0; i < 256; ++i) {
    std::uint64_t crc = i << 56;
    for (int b = 0; b < 8; ++b) crc = (crc & (1ull << 63)) ? (crc << 1) ^ kPolynomial : crc << 1;
    table[i] = crc;
  }
  return table;
}
constexpr auto kTable = make_table();

std::uint64_t get(const std::uint8_t* p, int n) noexcept {
  std::uint64_t v = 0;
  for (int i = 0; i < n; ++i) v = (v << 8) | p[i];
  return v;
}
void put(std::uint8_t* p, std::uint64_t v, int n) noexcept {
  for (int i = n - 1; i >= 0; --i, v >>= 8) p[i] = static_cast<std::uint8_t>(v);
}

}  // namespace

std::uint64_t igtl_crc64(std::span<const std::uint8_t> data) noexcept {
  std::uint64_t crc = 0;
  for (const std::uint8_t byte : data) crc = kTable[(crc >> 56) ^ byte] ^ (crc << 8);
  return crc;
}

namespace detail {

std::string_view igtl_text(const std::uint8_t* bytes, std::size_t room) noexcept {
  const auto* text = reinterpret_cast<const char*>(bytes);
  return {text, ::strnlen(text, room)};
}

bool igtl_content(const IgtlHeader& header, std::span<const std::uint8_t>& body) noexcept {
  if (header.version < 2) return true;
  if (body.size() < 12) return false;
  const std::uint64_t head = get(body.data(), 2), meta = get(body.data() + 2, 2) + get(body.data() + 4, 4);
  if (head < 12 || head > body.size() || meta > body.size() - head) return false;
  body = body.subspan(head, body.size() - head - meta);
  return true;
}

/// Columns of the rotation, then the translation [mm].
IgtlPose igtl_pose(std::string_view name, const std::uint8_t* bytes) noexcept {
  IgtlPose pose;
  pose.name = name;
  double v[12];
  for (int i = 0; i < 12; ++i) v[i] = std::bit_cast<float>(static_cast<std::uint32_t>(get(bytes + 4 * i, 4)));
  Mat3 R;
  for (int i = 0; i < 9; ++i) R(i % 3, i / 3) = v[i];
  pose.X.p = 1e-3 * Vec3(v[9], v[10], v[11]);
  if (!R.allFinite() || !pose.X.p.allFinite() || pose.X.p.cwiseAbs().maxCoeff() > kReach) return pose;
  if (!((R.transpose() * R - Mat3::Identity()).cwiseAbs().maxCoeff() < 0.01) || R.determinant() < 0.0) return pose;
  pose.X.q = Quat(R).normalized();
  pose.sound = true;
  return pose;
}

}  // namespace detail

bool igtl_header(std::span<const std::uint8_t> bytes, IgtlHeader& h) noexcept {
  if (bytes.size() < kIgtlHeader) return false;
  h.version = static_cast<int>(get(bytes.data(), 2));
  h.type = detail::igtl_text(bytes.data() + 2, 12);
  h.device = detail::igtl_text(bytes.data() + 14, 20);
  const std::uint64_t seconds = get(bytes.data() + 34, 4), fraction = get(bytes.data() + 38, 4);
  h.time_us = static_cast<std::int64_t>(seconds * 1'000'000 + (fraction * 1'000'000 >> 32));
  h.body_size = get(bytes.data() + 42, 8);
  h.crc = get(bytes.data() + 50, 8);
  return h.version >= 1 && h.version <= 3 && !h.type.empty();
}

std::size_t igtl_transform(std::string_view device, const Pose& X, std::int64_t time_us, std::span<std::uint8_t> out) noexcept {
  if (out.size() < kIgtlTransform) return 0;
  std::memset(out.data(), 0, kIgtlTransform);
  put(out.data(), 1, 2);
  std::memcpy(out.data() + 2, "TRANSFORM", 9);
  std::memcpy(out.data() + 14, device.data(), std::min<std::size_t>(device.size(), 19));
  put(out.data() + 34, static_cast<std::uint64_t>(time_us / 1'000'000), 4);
  put(out.data() + 38, (static_cast<std::uint64_t>(time_us % 1'000'000) << 32) / 1'000'000, 4);
  put(out.data() + 42, 48, 8);
  const Mat3 R = X.q.toRotationMatrix();
  for (int i = 0; i < 12; ++i) {
    const double v = i < 9 ? R(i % 3, i / 3) : 1e3 * X.p[i - 9];
    put(out.data() + kIgtlHeader + 4 * i, std::bit_cast<std::uint32_t>(static_cast<float>(v)), 4);
  }
  put(out.data() + 50, igtl_crc64(out.subspan(kIgtlHeader, 48)), 8);
  return kIgtlTransform;
}

}  // namespace filum
