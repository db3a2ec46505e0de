#include "base/units.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <system_error>

#include "base/error.h"

namespace filum {
namespace {

constexpr std::size_t kMaxText = 128;  // also bounds the depth of brackets
constexpr int kMaxPower = 12;

struct Symbol {
  std::string_view name;
  double scale;  // to SI
  bool prefixes;
  Dimension dimension;
};

constexpr Dimension dim(int m, int kg, int s, int K = 0, int A = 0, int mol = 0, int cd = 0, int rad = 0,
                        int count = 0) {
  return Dimension{{m, kg, s, K, A, mol, cd, rad, count}};
}

constexpr double kPi = 3.14159265358979323846;
constexpr double kStandardGravity = 9.80665;  // [m/s2], exact by definition

// Exact names are looked up before prefixes are split off, so "min" is a minute and "cd" a candela.
constexpr Symbol kSymbols[] = {
    {"m", 1, true, dim(1, 0, 0)},
    {"g", 1e-3, true, dim(0, 1, 0)},
    {"s", 1, true, dim(0, 0, 1)},
    {"K", 1, true, dim(0, 0, 0, 1)},
    {"A", 1, true, dim(0, 0, 0, 0, 1)},
    {"mol", 1, true, dim(0, 0, 0, 0, 0, 1)},
    {"cd", 1, true, dim(0, 0, 0, 0, 0, 0, 1)},
    {"rad", 1, true, dim(0, 0, 0, 0, 0, 0, 0, 1)},
    {"sr", 1, true, dim(0, 0, 0, 0, 0, 0, 0, 2)},
    {"count", 1, true, dim(0, 0, 0, 0, 0, 0, 0, 0, 1)},
    {"min", 60, false, dim(0, 0, 1)},
    {"h", 3600, false, dim(0, 0, 1)},
    {"d", 86400, false, dim(0, 0, 1)},
    {"t", 1e3, true, dim(0, 1, 0)},
    {"deg", kPi / 180, false, dim(0, 0, 0, 0, 0, 0, 0, 1)},
    {"rev", 2 * kPi, false, dim(0, 0, 0, 0, 0, 0, 0, 1)},
    {"l", 1e-3, true, dim(3, 0, 0)},
    {"L", 1e-3, true, dim(3, 0, 0)},
    {"Hz", 1, true, dim(0, 0, -1)},
    {"N", 1, true, dim(1, 1, -2)},
    {"gf", 1e-3 * kStandardGravity, true, dim(1, 1, -2)},
    {"Pa", 1, true, dim(-1, 1, -2)},
    {"bar", 1e5, true, dim(-1, 1, -2)},
    {"mmHg", 133.322387415, false, dim(-1, 1, -2)},
    {"cmH2O", 98.0665, false, dim(-1, 1, -2)},
    {"J", 1, true, dim(2, 1, -2)},
    {"W", 1, true, dim(2, 1, -3)},
    {"C", 1, true, dim(0, 0, 1, 0, 1)},
    {"V", 1, true, dim(2, 1, -3, 0, -1)},
    {"ohm", 1, true, dim(2, 1, -3, 0, -2)},
    {"S", 1, true, dim(-2, -1, 3, 0, 2)},
    {"F", 1, true, dim(-2, -1, 4, 0, 2)},
    {"H", 1, true, dim(2, 1, -2, 0, -2)},
    {"Wb", 1, true, dim(2, 1, -2, 0, -1)},
    {"T", 1, true, dim(0, 1, -2, 0, -1)},
    {"lm", 1, true, dim(0, 0, 0, 0, 0, 0, 1, 2)},
    {"lx", 1, true, dim(-2, 0, 0, 0, 0, 0, 1, 2)},
    {"Bq", 1, true, dim(0, 0, -1)},
    {"Gy", 1, true, dim(2, 0, -2)},
    {"Sv", 1, true, dim(2, 0, -2)},
    {"kat", 1, true, dim(0, 0, -1, 0, 0, 1)},
    {"%", 1e-2, false, dim(0, 0, 0)},
};

struct Prefix {
  std::string_view name;
  int exponent;
};
constexpr Prefix kPrefixes[] = {
    {"da", 1},  {"Y", 24},  {"Z", 21},  {"E", 18},  {"P", 15},        {"T", 12},        {"G", 9},  {"M", 6},
    {"k", 3},   {"h", 2},   {"d", -1},  {"c", -2},  {"m", -3},        {"u", -6},        {"n", -9}, {"p", -12},
    {"f", -15}, {"a", -18}, {"z", -21}, {"y", -24}, {"\xC2\xB5", -6}, {"\xCE\xBC", -6},
};

struct Unit {
  double scale = 1.0;
  Dimension dimension;
};

/// Multiplying by 1e-6 is off by an ulp where dividing by 1e6 is not: "25 um" shall be the same double as
/// 25e-6.
double scaled(double value, double scale) {
  if (scale < 1.0) {
    const double inverse = std::round(1.0 / scale);
    if (inverse < 1e16 && 1.0 / inverse == scale) return value / inverse;
  }
  return value * scale;
}

const Symbol* find_symbol(std::string_view name) {
  for (const Symbol& symbol : kSymbols)
    if (symbol.name == name) return &symbol;
  return nullptr;
}

std::optional<Unit> lookup(std::string_view name) {
  if (const Symbol* symbol = find_symbol(name)) return Unit{symbol->scale, symbol->dimension};
  for (const Prefix& prefix : kPrefixes) {
    if (!name.starts_with(prefix.name)) continue;
    const Symbol* symbol = find_symbol(name.substr(prefix.name.size()));
    if (symbol == nullptr || !symbol->prefixes) continue;
    const double factor = std::pow(10.0, std::abs(prefix.exponent));
    // 1e3 * 1e-3 is exact this way round, so that kg is exactly 1.
    return Unit{prefix.exponent > 0 ? scaled(factor, symbol->scale) : symbol->scale / factor,
                symbol->dimension};
  }
  return std::nullopt;
}

class UnitParser {
 public:
  explicit UnitParser(std::string_view text) : rest_(text) {}

  std::optional<Unit> parse() {
    if (rest_ == "-" || rest_.empty()) return Unit{};
    const std::optional<Unit> unit = product();
    if (!unit || !rest_.empty() || !std::isfinite(unit->scale) || unit->scale == 0.0) return std::nullopt;
    return unit;
  }

 private:
  bool take(std::string_view token) {
    if (!rest_.starts_with(token)) return false;
    rest_.remove_prefix(token.size());
    return true;
  }

  std::optional<Unit> product() {
    std::optional<Unit> left = factor();
    while (left && !rest_.empty()) {
      int sign = 1;
      if (take("/")) {
        sign = -1;
      } else if (!take(".") && !take("*") && !take("\xC2\xB7")) {
        break;
      }
      const std::optional<Unit> right = factor();
      if (!right || !multiply(*left, *right, sign)) return std::nullopt;
    }
    return left;
  }

  std::optional<Unit> factor() {
    std::optional<Unit> base;
    if (take("1")) return Unit{};
    if (take("(")) {
      base = product();
      if (!base || !take(")")) return std::nullopt;
    } else {
      base = symbol();
    }
    if (!base) return std::nullopt;
    const std::optional<int> exponent = power();
    if (!exponent) return std::nullopt;
    Unit result;
    if (!multiply(result, *base, *exponent)) return std::nullopt;
    return result;
  }

  std::optional<Unit> symbol() {
    if (rest_.starts_with("cmH2O")) {  // the one symbol with a digit inside
      rest_.remove_prefix(5);
      return lookup("cmH2O");
    }
    std::size_t n = 0;
    while (n < rest_.size() &&
           (std::isalpha(static_cast<unsigned char>(rest_[n])) != 0 || rest_[n] == '%' || is_micro(n)))
      n += is_micro(n) ? 2 : 1;
    const std::string_view name = rest_.substr(0, n);
    rest_.remove_prefix(n);
    return lookup(name);
  }

  bool is_micro(std::size_t at) const {
    const std::string_view two = rest_.substr(at, 2);
    return two == "\xC2\xB5" || two == "\xCE\xBC";
  }

  /// A missing power is 1.
  std::optional<int> power() {
    if (take("\xC2\xB2")) return 2;
    if (take("\xC2\xB3")) return 3;
    const bool caret = take("^");
    int value = 1;
    std::string_view digits = rest_;
    if (digits.starts_with("+")) digits.remove_prefix(1);
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error == std::errc::result_out_of_range) return std::nullopt;
    if (error != std::errc()) return caret ? std::nullopt : std::optional<int>(1);
    if (std::abs(value) > kMaxPower) return std::nullopt;
    rest_ = digits.substr(static_cast<std::size_t>(end - digits.data()));
    return value;
  }

  static bool multiply(Unit& left, const Unit& right, int exponent) {
    const double factor = std::pow(right.scale, std::abs(exponent));
    left.scale = exponent >= 0 ? left.scale * factor : left.scale / factor;
    for (std::size_t i = 0; i < left.dimension.power.size(); ++i) {
      left.dimension.power[i] += exponent * right.dimension.power[i];
      if (std::abs(left.dimension.power[i]) > 1000) return false;
    }
    return std::isfinite(left.scale);
  }

  std::string_view rest_;
};

std::string_view trimmed(std::string_view text) {
  const auto blank = [](char c) { return c == ' ' || c == '\t'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

std::optional<Unit> parse_unit(std::string_view text) {
  if (text.size() > kMaxText) return std::nullopt;
  return UnitParser(text).parse();
}

std::optional<double> parse_value(std::string_view text, const Dimension& dimension) {
  text = trimmed(text);
  if (text.empty() || text.size() > kMaxText) return std::nullopt;
  std::string_view number = text;
  if (number.starts_with('+')) number.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), value);
  if (error != std::errc() || !std::isfinite(value)) return std::nullopt;
  const std::string_view unit_name = trimmed(number.substr(static_cast<std::size_t>(end - number.data())));
  if (unit_name == "degC") {
    if (dimension != dim(0, 0, 0, 1)) return std::nullopt;
    return value + 273.15;
  }
  const std::optional<Unit> unit = parse_unit(unit_name);
  if (!unit || unit->dimension != dimension) return std::nullopt;
  const double result = scaled(value, unit->scale);
  if (!std::isfinite(result)) return std::nullopt;
  return result;
}

std::string quoted(std::string_view text) {
  std::string shown;
  for (const char c : text.substr(0, 60)) shown += (static_cast<unsigned char>(c) < 0x20 ? '?' : c);
  return "\"" + shown + (text.size() > 60 ? "...\"" : "\"");
}

std::string expected_like(std::string_view unit) {
  if (unit == "-" || unit.empty()) return "a number without a unit, e.g. 0.2";
  return "a number with a unit like " + std::string(unit) + ", e.g. 1.5 " + std::string(unit);
}

double parse_or_refuse(std::string_view text, const Dimension& dimension, std::string_view unit_like,
                       const std::string& file, const std::string& field) {
  const std::optional<double> value = parse_value(text, dimension);
  if (!value) throw InputError(file, field, quoted(text), expected_like(unit_like));
  return *value;
}

std::string number_text(double value, int digits) {
  char buffer[48];
  std::snprintf(buffer, sizeof buffer, "%.*g", digits, value);
  return buffer;
}

}  // namespace

Dimension dimension_of(std::string_view unit) {
  if (unit == "degC") return dim(0, 0, 0, 1);
  const std::optional<Unit> parsed = parse_unit(unit);
  if (!parsed)
    throw InputError("value", "unit", quoted(unit), "a unit such as mm, GPa, kg/m3, N.m2, deg or -");
  return parsed->dimension;
}

double parse_quantity(std::string_view text, const Dimension& dimension, const std::string& file,
                      const std::string& field) {
  return parse_or_refuse(text, dimension, unit_text(dimension), file, field);
}

double parse_quantity(std::string_view text, std::string_view unit_like, const std::string& file,
                      const std::string& field) {
  return parse_or_refuse(text, dimension_of(unit_like), unit_like, file, field);
}

double unit_scale(std::string_view unit) {
  const std::optional<Unit> parsed = parse_unit(unit);
  if (!parsed)
    throw InputError("value", "unit", quoted(unit), "a unit such as mm, GPa, kg/m3, N.m2, deg or -");
  return parsed->scale;
}

std::string unit_text(const Dimension& dimension) {
  constexpr std::string_view kNames[] = {"m", "kg", "s", "K", "A", "mol", "cd", "rad", "count"};
  std::string above;
  std::string below;
  for (std::size_t i = 0; i < dimension.power.size(); ++i) {
    const int power = dimension.power[i];
    if (power == 0) continue;
    std::string factor(kNames[i]);
    if (std::abs(power) != 1) factor += std::to_string(std::abs(power));
    if (power < 0) {
      below += "/" + factor;
    } else {
      above += (above.empty() ? "" : ".") + factor;
    }
  }
  if (above.empty()) return below.empty() ? "-" : "1" + below;
  return above + below;
}

std::string format_quantity(double value, std::string_view unit, int digits) {
  if (unit == "degC") return number_text(value - 273.15, digits) + " degC";
  const std::string number = number_text(value / unit_scale(unit), digits);
  return unit == "-" || unit.empty() ? number : number + " " + std::string(unit);
}

std::string format_prefixed(double value, std::string_view unit, int digits) {
  constexpr std::string_view kThousands[] = {"a", "f", "p", "n", "u", "m", "", "k", "M", "G", "T", "P", "E"};
  constexpr int kNone = 6;
  int step = 0;
  if (value != 0.0 && std::isfinite(value)) {
    // The rounding to `digits` comes first: 999.99 um with 4 digits is 1 mm.
    const double rounded = std::strtod(number_text(std::abs(value), digits).c_str(), nullptr);
    step = static_cast<int>(std::floor(std::log10(rounded) / 3.0 + 1e-12));
    step = std::min(std::max(step, -kNone), kNone);
  }
  const double shown = value / std::pow(10.0, 3 * step);
  return number_text(shown, digits) + " " + std::string(kThousands[step + kNone]) + std::string(unit);
}

}  // namespace filum
