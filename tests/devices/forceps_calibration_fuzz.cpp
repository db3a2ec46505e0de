// Any text either is refused or gives a calibration whose values are finite and within its limits.

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "base/error.h"
#include "devices/forceps_calibration.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const auto c = filum::ForcepsCalibration::parse({reinterpret_cast<const char*>(data), size}, "fuzz.yaml");
    for (int count = 0; count <= 65535; count += 4369) {
      const double angle = c.angle(static_cast<std::uint16_t>(count)),
                   force = c.force(static_cast<std::uint16_t>(count));
      if (!(angle >= -c.angle_limit && angle <= c.angle_limit) || !(force >= 0.0 && force <= c.force_limit))
        std::abort();
    }
  } catch (const filum::InputError&) {
  }
  return 0;
}
