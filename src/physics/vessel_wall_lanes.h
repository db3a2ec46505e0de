#pragma once
// Four doubles at once: the elements of the wall are computed in packs of four. Plain vector types of GCC and clang, so that
// processors without AVX run the same code in halves. sqrt, exp and choice exist for double as well, for the scalar twin.
// Test: vessel_wall_lanes_test.

#include <cmath>
#include <cstdint>
#include <cstring>

namespace filum {

inline constexpr int kLanes = 4;
using Lanes = double __attribute__((vector_size(32)));
using LaneBits = std::int64_t __attribute__((vector_size(32)));

inline Lanes all_lanes(double v) noexcept { return Lanes{v, v, v, v}; }
inline double sum_of(const Lanes& v) noexcept { return (v[0] + v[1]) + (v[2] + v[3]); }
inline double sum_of(double v) noexcept { return v; }

template <class S>
S value_of(double v) noexcept;
template <>
inline double value_of<double>(double v) noexcept {
  return v;
}
template <>
inline Lanes value_of<Lanes>(double v) noexcept {
  return all_lanes(v);
}

inline double root_of(double v) noexcept { return std::sqrt(v); }
inline Lanes root_of(const Lanes& v) noexcept { return Lanes{std::sqrt(v[0]), std::sqrt(v[1]), std::sqrt(v[2]), std::sqrt(v[3])}; }

inline double least_of(double a, double b) noexcept { return a < b ? a : b; }
inline Lanes least_of(const Lanes& a, const Lanes& b) noexcept { return a < b ? a : b; }
inline double positive_part(double a) noexcept { return a > 0.0 ? a : 0.0; }
inline Lanes positive_part(const Lanes& a) noexcept {
  const Lanes zero = all_lanes(0.0);
  return a > zero ? a : zero;
}

inline double exp_of(double v) noexcept { return std::exp(v); }

/// e^v for |v| < 700 to 1e-15: v = n ln 2 + r, e^r by its series to r^13, 2^n by the exponent's bits.
inline Lanes exp_of(const Lanes& v) noexcept {
  constexpr double kLog2e = 1.4426950408889634, kLn2High = 0.693147180369123816490, kLn2Low = 1.90821492927058770002e-10;
  constexpr double kShift = 6755399441055744.0;  // 1.5 x 2^52: adding it rounds to an integer, kept in the low bits
  const Lanes shifted = v * kLog2e + kShift;
  const Lanes n = shifted - kShift;
  const Lanes r = (v - n * kLn2High) - n * kLn2Low;
  Lanes s = all_lanes(1.0 / 6227020800.0);
  constexpr double kInverse[] = {1.0 / 479001600.0, 1.0 / 39916800.0, 1.0 / 3628800.0, 1.0 / 362880.0, 1.0 / 40320.0, 1.0 / 5040.0,
                                 1.0 / 720.0,       1.0 / 120.0,      1.0 / 24.0,      1.0 / 6.0,      0.5,           1.0, 1.0};
  for (const double c : kInverse) s = s * r + c;
  LaneBits bits;
  std::memcpy(&bits, &shifted, sizeof bits);
  bits = (bits << 52) + (std::int64_t{1023} << 52);
  Lanes power;
  std::memcpy(&power, &bits, sizeof power);
  return s * power;
}

}  // namespace filum
