// Any bytes as a file of calibration readings: refused with an InputError, or fitted or refused with a reason.
#include <cstdint>
#include <string>

#include "base/error.h"
#include "devices/calibration_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const auto readings = filum::parse_readings(std::string(reinterpret_cast<const char*>(data), size), "fuzz.yaml");
    const filum::CalibrationFit fit = filum::fit_line(readings.angle, {}, "deg", 0.0174533);
    if (fit.good != fit.why.empty()) __builtin_trap();
  } catch (const filum::InputError&) {
  }
  return 0;
}
