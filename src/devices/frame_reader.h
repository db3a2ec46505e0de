#pragma once
// Cuts a byte stream into frames of hardware/protocol and keeps count of what it had to refuse. Pure: no
// port, no clock, no allocation; bytes may arrive in pieces of any size.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "hardware/protocol/filum_protocol.h"

namespace filum {

struct FrameCounts {
  std::uint64_t good = 0;
  std::uint64_t bad_cobs = 0;
  std::uint64_t bad_length = 0;
  std::uint64_t bad_crc = 0;
  std::uint64_t bad_version = 0;
  std::uint64_t bad_type = 0;
  std::uint64_t corrupt() const noexcept { return bad_cobs + bad_length + bad_crc + bad_version + bad_type; }
};

class FrameReader {
 public:
  /// Calls on_frame(const filum_frame&) for each good frame that ends in `bytes`.
  template <class OnFrame>
  void feed(std::span<const std::uint8_t> bytes, OnFrame&& on_frame) {
    filum_frame frame;
    for (const std::uint8_t byte : bytes)
      if (take(byte, frame)) on_frame(static_cast<const filum_frame&>(frame));
  }

  /// Forget the bytes of an unfinished frame: the port was reopened. The counts stay.
  void restart() noexcept;
  const FrameCounts& counts() const noexcept { return counts_; }

 private:
  /// True when this byte closed a good frame.
  bool take(std::uint8_t byte, filum_frame& frame) noexcept;
  void count(filum_status status) noexcept;

  std::array<std::uint8_t, FILUM_MAX_ENCODED> buffer_{};
  std::size_t size_ = 0;
  bool too_long_ = false;
  bool in_step_ = false;  // a 0x00 was seen since the start; before it, half a frame is nobody's fault
  FrameCounts counts_;
};

}  // namespace filum
