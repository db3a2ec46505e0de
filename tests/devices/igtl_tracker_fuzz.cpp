// Any bytes from an OpenIGTLink peer: no pose that is not finite, no rotation that is none, nothing kept beyond a message.
#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "devices/igtl_tracker.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  filum::IgtlTracker tracker;
  std::vector<filum::DeviceSample> samples;
  tracker.feed({data, size / 2}, 0, samples);
  tracker.feed({data + size / 2, size - size / 2}, 1000, samples);
  for (const filum::DeviceSample& s : samples)
    if (!s.X_WD.finite() || std::abs(s.X_WD.q.norm() - 1.0) > 1e-9 || s.tool < 0 || s.tool > 2) std::abort();
  return 0;
}
