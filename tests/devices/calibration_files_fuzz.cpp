// The forceps' calibration (values finite and within its limits) and the readings that it is fitted to (fitted, or refused with a reason),
// told apart by their format line; any other text goes to both.

#include "devices/calibration_file.h"
#include "devices/forceps_calibration.h"
#include "fuzz_folder.h"

namespace {

void read_calibration(const std::string& text) {
  const auto c = filum::ForcepsCalibration::parse(text, "fuzz.yaml");
  for (int count = 0; count <= 65535; count += 4369) {
    const double angle = c.angle(static_cast<std::uint16_t>(count)), force = c.force(static_cast<std::uint16_t>(count));
    if (!(angle >= -c.angle_limit && angle <= c.angle_limit) || !(force >= 0.0 && force <= c.force_limit)) std::abort();
  }
}

void read_readings(const std::string& text) {
  const auto readings = filum::parse_readings(text, "fuzz.yaml");
  const filum::CalibrationFit fit = filum::fit_line(readings.angle, {}, "deg", 0.0174533);
  if (fit.good != fit.why.empty()) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace filum;
  const std::string text(fuzz::text_of(data, size));
  const auto format = fuzz::format_of(text);
  if (format != "filum-calibration-points/1") fuzz::read([&] { read_calibration(text); });
  if (format != "filum-forceps/1") fuzz::read([&] { read_readings(text); });
  return 0;
}
