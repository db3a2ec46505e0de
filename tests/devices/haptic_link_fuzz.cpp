// Any bytes as a datagram: refused, or a pose whose numbers are those of a hand; what was decoded is encoded to the same bytes.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>

#include "devices/haptic_link.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  filum_link_pose pose{};
  filum_link_force force{};
  filum_link_get_force(data, size, &force);
  if (!filum_link_get_pose(data, size, &pose)) return 0;
  filum::DeviceSample sample;
  if (filum::sample_of(pose, sample) && !(sample.X_WD.finite() && std::isfinite(sample.grip_angle))) std::abort();
  std::uint8_t again[FILUM_LINK_POSE_SIZE];
  filum_link_put_pose(&pose, again);
  if (std::memcmp(again, data, 56) != 0) std::abort();
  return 0;
}
