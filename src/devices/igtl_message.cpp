#include "devices/igtl_message.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include <igtl_header.h>
#include <igtl_tdata.h>
#include <igtl_transform.h>
#include <igtl_util.h>

#include "devices/sample_check.h"

namespace filum {
namespace {

static_assert(sizeof(::igtl_header) == kIgtlHeader && sizeof(igtl_tdata_element) == kIgtlElement);

std::uint64_t get(const std::uint8_t* p, int n) noexcept {
  std::uint64_t v = 0;
  for (int i = 0; i < n; ++i) v = (v << 8) | p[i];
  return v;
}

}  // namespace

std::uint64_t igtl_crc64(std::span<const std::uint8_t> data) noexcept {
  return crc64(const_cast<unsigned char*>(data.data()), data.size(), 0);  // the library only reads
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
  float v[12];
  std::memcpy(v, bytes, sizeof v);
  igtl_transform_convert_byte_order(v);
  Mat3 R;
  for (int i = 0; i < 9; ++i) R(i % 3, i / 3) = static_cast<double>(v[i]);
  pose.X.p = 1e-3 * Vec3(v[9], v[10], v[11]);
  if (!R.allFinite() || !pose.X.p.allFinite() || pose.X.p.cwiseAbs().maxCoeff() > kHandReach) return pose;
  if (!((R.transpose() * R - Mat3::Identity()).cwiseAbs().maxCoeff() < 0.01) || R.determinant() < 0.0) return pose;
  pose.X.q = Quat(R).normalized();
  pose.sound = true;
  return pose;
}

}  // namespace detail

bool igtl_header(std::span<const std::uint8_t> bytes, IgtlHeader& h) noexcept {
  if (bytes.size() < kIgtlHeader) return false;
  ::igtl_header raw;
  std::memcpy(&raw, bytes.data(), sizeof raw);
  igtl_header_convert_byte_order(&raw);
  h.version = raw.version;
  h.type = detail::igtl_text(bytes.data() + offsetof(::igtl_header, name), IGTL_HEADER_TYPE_SIZE);
  h.device = detail::igtl_text(bytes.data() + offsetof(::igtl_header, device_name), IGTL_HEADER_NAME_SIZE);
  const std::uint64_t seconds = raw.timestamp >> 32, fraction = raw.timestamp & 0xffffffffu;
  h.time_us = static_cast<std::int64_t>(seconds * 1'000'000 + (fraction * 1'000'000 >> 32));
  h.body_size = raw.body_size;
  h.crc = raw.crc;
  return h.version >= 1 && h.version <= 3 && !h.type.empty();
}

std::size_t igtl_transform(std::string_view device, const Pose& X, std::int64_t time_us, std::span<std::uint8_t> out) noexcept {
  if (out.size() < kIgtlTransform) return 0;
  const Mat3 R = X.q.toRotationMatrix();
  float v[12];
  for (int i = 0; i < 12; ++i) v[i] = static_cast<float>(i < 9 ? R(i % 3, i / 3) : 1e3 * X.p[i - 9]);
  igtl_transform_convert_byte_order(v);
  ::igtl_header raw{};
  raw.version = 1;
  std::memcpy(raw.name, "TRANSFORM", 9);
  std::memcpy(raw.device_name, device.data(), std::min<std::size_t>(device.size(), IGTL_HEADER_NAME_SIZE - 1));
  const auto seconds = static_cast<std::uint64_t>(time_us / 1'000'000), rest = static_cast<std::uint64_t>(time_us % 1'000'000);
  raw.timestamp = seconds << 32 | (rest << 32) / 1'000'000;
  raw.body_size = IGTL_TRANSFORM_SIZE;
  raw.crc = igtl_transform_get_crc(v);
  igtl_header_convert_byte_order(&raw);
  std::memcpy(out.data(), &raw, sizeof raw);
  std::memcpy(out.data() + sizeof raw, v, sizeof v);
  return kIgtlTransform;
}

}  // namespace filum
