#include "devices/frame_reader.h"

namespace filum {

void FrameReader::restart() noexcept {
  size_ = 0;
  too_long_ = in_step_ = false;
}

void FrameReader::count(filum_status status) noexcept {
  switch (status) {
    case FILUM_OK:
      ++counts_.good;
      break;
    case FILUM_BAD_COBS:
      ++counts_.bad_cobs;
      break;
    case FILUM_BAD_LENGTH:
      ++counts_.bad_length;
      break;
    case FILUM_BAD_CRC:
      ++counts_.bad_crc;
      break;
    case FILUM_BAD_VERSION:
      ++counts_.bad_version;
      break;
    case FILUM_BAD_TYPE:
      ++counts_.bad_type;
      break;
  }
}

bool FrameReader::take(std::uint8_t byte, filum_frame& frame) noexcept {
  if (byte != 0) {
    if (size_ < buffer_.size())
      buffer_[size_++] = byte;
    else
      too_long_ = true;
    return false;
  }
  const std::size_t size = size_;
  const bool too_long = too_long_, was_in_step = in_step_;
  size_ = 0;
  too_long_ = false;
  in_step_ = true;
  if (size == 0) return false;  // zeros between frames are allowed
  const filum_status status = too_long ? FILUM_BAD_LENGTH : filum_frame_decode(buffer_.data(), size, &frame);
  if (status == FILUM_OK || was_in_step) count(status);
  return status == FILUM_OK;
}

}  // namespace filum
