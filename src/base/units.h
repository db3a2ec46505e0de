#pragma once
// Quantities in files and on the command line carry their unit as text ("0.35 mm", "2.5 GPa", "4.79e-11
// N.m2"); inside the program everything is an SI double. Grammar of a unit: factors joined by "." or "*" or
// "/", each a symbol with an SI prefix and an integer power ("m2", "m^2", "s-1"), and brackets: "J/(kg.K)".
// "1/s" and "-" (no unit) are allowed.

#include <array>
#include <string>
#include <string_view>

namespace filum {

/// Powers of the base units; angle and count are kept apart so that "deg" cannot pass for a length ratio.
struct Dimension {
  enum Base { kMetre, kKilogram, kSecond, kKelvin, kAmpere, kMole, kCandela, kRadian, kCount, kBases };
  std::array<int, kBases> power{};
  bool operator==(const Dimension&) const = default;
};

/// The dimension of a unit: dimension_of("N.m2"). Throws InputError for an unknown unit.
Dimension dimension_of(std::string_view unit);

/// "0.35 mm" -> 3.5e-4. Throws InputError(file, field, text, expected) when the text is no finite number with
/// a known unit of this dimension. degC is an absolute temperature and becomes K.
double parse_quantity(std::string_view text, const Dimension& dimension, const std::string& file = "value",
                      const std::string& field = "quantity");

/// Same, with the dimension and the wording of the error taken from an example unit: parse_quantity("25 um",
/// "mm").
double parse_quantity(std::string_view text, std::string_view unit_like, const std::string& file = "value",
                      const std::string& field = "quantity");

/// SI value of one `unit` ("mm" -> 1e-3). Throws InputError for an unknown unit or degC, which has an offset.
double unit_scale(std::string_view unit);

/// "kg.m/s2" for a dimension, "-" for none.
std::string unit_text(const Dimension& dimension);

/// Shortest text with `digits` significant digits in the unit given: format_quantity(3.5e-4, "mm") -> "0.35
/// mm".
std::string format_quantity(double value, std::string_view unit, int digits = 4);

/// With the SI prefix that leaves 1 to 3 digits before the point: format_prefixed(3.5e-4, "m") -> "350 um".
/// `unit` is a single SI symbol of power one without prefix ("m", "N", "Pa", "s").
std::string format_prefixed(double value, std::string_view unit, int digits = 4);

}  // namespace filum
