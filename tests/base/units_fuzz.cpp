// Any text either gives a finite number or an InputError; what is formatted can be read back.

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "base/error.h"
#include "base/units.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  for (const char* unit : {"m", "Pa", "-", "K", "N.m2", "rad"}) {
    try {
      const double value = filum::parse_quantity(text, unit);
      if (!std::isfinite(value)) std::abort();
      const double back = filum::parse_quantity(filum::format_quantity(value, unit, 17), unit);
      if (std::abs(back - value) > 1e-15 * std::abs(value)) std::abort();
    } catch (const filum::InputError&) {
    }
  }
  try {
    const filum::Dimension dimension = filum::dimension_of(text);
    if (filum::dimension_of(filum::unit_text(dimension)) != dimension) std::abort();
  } catch (const filum::InputError&) {
  }
  return 0;
}
