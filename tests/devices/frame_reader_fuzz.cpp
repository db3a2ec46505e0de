// Any bytes in any pieces: no frame but a valid one comes out, no sample but a plausible one, and every count
// adds up.

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <vector>

#include "devices/forceps_stream.h"
#include "devices/sample_check.h"

namespace {

filum::ForcepsCalibration calibration() {
  filum::ForcepsCalibration c;
  c.angle_gain = 1e-4;
  c.force_gain = 1e-3;
  c.angle_limit = 0.6;
  c.force_limit = 5.0;
  return c;
}

void check_frame(const filum_frame& frame) {
  std::uint8_t wire[FILUM_MAX_WIRE];
  filum_frame again;
  const std::size_t n = filum_frame_encode(&frame, wire);
  if (n < 2 || wire[n - 1] != 0 || filum_frame_decode(wire, n - 1, &again) != FILUM_OK) std::abort();
  if (!std::equal(frame.payload, frame.payload + frame.size, again.payload)) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::size_t piece = 1 + data[0] % 64;
  const std::span<const std::uint8_t> bytes(data + 1, size - 1);
  filum::FrameReader reader;
  std::uint64_t frames = 0;
  const auto on_frame = [&](const filum_frame& frame) {
    check_frame(frame);
    ++frames;
  };
  filum::ForcepsStream stream(calibration());
  std::vector<filum::DeviceSample> samples;
  for (std::size_t at = 0; at < bytes.size(); at += piece) {
    const auto part = bytes.subspan(at, std::min(piece, bytes.size() - at));
    reader.feed(part, on_frame);
    stream.feed(part, static_cast<std::int64_t>(at) * 100, samples);
  }
  if (reader.counts().good != frames || stream.frames().good != frames) std::abort();
  if (stream.received() != samples.size() || stream.received() + stream.rejected() > frames) std::abort();
  for (const filum::DeviceSample& sample : samples)
    if (filum::fault_of(sample) != filum::SampleFault::none) std::abort();
  return 0;
}
