#pragma once
// OpenIGTLink messages (protocol version 3; J. Tokuda et al., Int. J. Med. Robotics 5 (2009) 423), as far as tool poses need
// them: TRANSFORM and TDATA in, TRANSFORM out. Pure: bytes in, poses out. The layouts, byte orders and checksums are the C part of
// libOpenIGTLink; not its classes, because the bytes come from the network: nothing is allocated by a length that a peer names.
// tests/devices/igtl_library_test checks both ways against the classes.
//
// Header, big-endian, 58 bytes: version u16, type char[12], device char[20], time u64 (seconds 32.32), body size u64, CRC-64
// (ECMA-182) of the body. Version 2 bodies begin with an extended header and end with metadata. Lengths in millimetres.

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "base/pose.h"

namespace filum {

struct IgtlHeader {
  int version = 0;
  std::string_view type, device;  // into the bytes given
  std::int64_t time_us = 0;       // [us], of the sender's clock
  std::uint64_t body_size = 0;    // [byte]
  std::uint64_t crc = 0;
};

inline constexpr std::size_t kIgtlHeader = 58;     // [byte]
inline constexpr std::size_t kIgtlElement = 70;    // [byte], of one tool in TDATA
inline constexpr std::size_t kIgtlLongest = 65536; // [byte], of a body that is read; poses need a few hundred

std::uint64_t igtl_crc64(std::span<const std::uint8_t> data) noexcept;

/// False if these 58 bytes are no header of a version that is known.
bool igtl_header(std::span<const std::uint8_t> bytes, IgtlHeader& header) noexcept;

/// One pose of a message.
struct IgtlPose {
  std::string_view name;
  Pose X;            // [m]
  bool sound = false;  // false: not a rotation, not finite or out of reach
};

enum class IgtlBody { poses, other, damaged };
/// Calls `take(const IgtlPose&)` for each pose of a TRANSFORM or TDATA; `body` is as long as the header says.
template <class Take>
IgtlBody igtl_body(const IgtlHeader& header, std::span<const std::uint8_t> body, Take&& take);

/// A TRANSFORM message; returns its size.
inline constexpr std::size_t kIgtlTransform = kIgtlHeader + 48;
std::size_t igtl_transform(std::string_view device, const Pose& X, std::int64_t time_us, std::span<std::uint8_t> out) noexcept;

namespace detail {
/// Cuts the extended header and the metadata of version 2 off; false if they do not fit.
bool igtl_content(const IgtlHeader& header, std::span<const std::uint8_t>& body) noexcept;
IgtlPose igtl_pose(std::string_view name, const std::uint8_t* twelve_floats) noexcept;
std::string_view igtl_text(const std::uint8_t* bytes, std::size_t room) noexcept;
}  // namespace detail

template <class Take>
IgtlBody igtl_body(const IgtlHeader& header, std::span<const std::uint8_t> body, Take&& take) {
  if (body.size() != header.body_size || igtl_crc64(body) != header.crc) return IgtlBody::damaged;
  if (header.type != "TRANSFORM" && header.type != "TDATA") return IgtlBody::other;
  if (!detail::igtl_content(header, body)) return IgtlBody::damaged;
  if (header.type == "TRANSFORM") {
    if (body.size() != 48) return IgtlBody::damaged;
    take(detail::igtl_pose(header.device, body.data()));
    return IgtlBody::poses;
  }
  if (body.size() % kIgtlElement != 0) return IgtlBody::damaged;
  for (std::size_t at = 0; at < body.size(); at += kIgtlElement)
    take(detail::igtl_pose(detail::igtl_text(body.data() + at, 20), body.data() + at + 22));
  return IgtlBody::poses;
}

}  // namespace filum
