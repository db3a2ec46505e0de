#pragma once
// Several numbers at once: the elements of the wall are computed in packs, of four in double precision and of eight in single, or sixteen
// where the processor has registers for them. Plain vector types of GCC and clang, so that processors without AVX run the same code in
// halves. sqrt, exp and choice exist for double as well, for the scalar twin. Test: vessel_wall_lanes_test.

#include <cmath>
#include <cstdint>
#include <cstring>

namespace filum {

template <class Number>
struct LaneFormat;
template <>
struct LaneFormat<double> {
  using Bit = std::int64_t;
  static constexpr double kShift = 6755399441055744.0;  // 1.5 x 2^52: adding it rounds to an integer, kept in the low bits
  static constexpr double kLn2High = 0.693147180369123816490, kLn2Low = 1.90821492927058770002e-10;
  static constexpr int kFraction = 52, kBias = 1023, kTerms = 13;
};
template <>
struct LaneFormat<float> {
  using Bit = std::int32_t;
  static constexpr float kShift = 12582912.0f;  // 1.5 x 2^23
  static constexpr float kLn2High = 0.693359375f, kLn2Low = -2.12194440e-4f;
  static constexpr int kFraction = 23, kBias = 127, kTerms = 7;
};

template <class Number_, int bytes = 32>
struct Lanes {
  using Number = Number_;
  using Bit = typename LaneFormat<Number>::Bit;
  using Vector [[gnu::vector_size(bytes)]] = Number;
  using Bits [[gnu::vector_size(bytes)]] = Bit;
  static constexpr int kWidth = bytes / static_cast<int>(sizeof(Number));
  alignas(bytes) Vector v;  // said here, since a compiler without such registers would align it less
  Lanes() = default;
  Lanes(Vector w) noexcept : v(w) {}
  Lanes(double s) noexcept : v(Vector{} + static_cast<Number>(s)) {}
  Number operator[](int k) const noexcept { return v[k]; }
  void set(int k, double s) noexcept { v[k] = static_cast<Number>(s); }
  Lanes& operator+=(const Lanes& b) noexcept {
    v += b.v;
    return *this;
  }
  Lanes& operator-=(const Lanes& b) noexcept {
    v -= b.v;
    return *this;
  }
  friend Lanes operator-(const Lanes& a) noexcept { return Lanes(-a.v); }
  friend Lanes operator+(const Lanes& a, const Lanes& b) noexcept { return Lanes(a.v + b.v); }
  friend Lanes operator-(const Lanes& a, const Lanes& b) noexcept { return Lanes(a.v - b.v); }
  friend Lanes operator*(const Lanes& a, const Lanes& b) noexcept { return Lanes(a.v * b.v); }
  friend Lanes operator/(const Lanes& a, const Lanes& b) noexcept { return Lanes(a.v / b.v); }
};

inline double root_of(double v) noexcept { return std::sqrt(v); }
template <class N, int bytes>
Lanes<N, bytes> root_of(const Lanes<N, bytes>& a) noexcept {
  Lanes<N, bytes> r;
  for (int k = 0; k < Lanes<N, bytes>::kWidth; ++k) r.v[k] = std::sqrt(a.v[k]);
  return r;
}

inline double least_of(double a, double b) noexcept { return a < b ? a : b; }
template <class N, int bytes>
Lanes<N, bytes> least_of(const Lanes<N, bytes>& a, const Lanes<N, bytes>& b) noexcept {
  return Lanes<N, bytes>(a.v < b.v ? a.v : b.v);
}
inline double positive_part(double a) noexcept { return a > 0.0 ? a : 0.0; }
template <class N, int bytes>
Lanes<N, bytes> positive_part(const Lanes<N, bytes>& a) noexcept {
  const typename Lanes<N, bytes>::Vector zero = {};
  return Lanes<N, bytes>(a.v > zero ? a.v : zero);
}

inline double exp_of(double v) noexcept { return std::exp(v); }

/// e^v to the last digits for |v| < 80: v = n ln 2 + r, e^r by its series, 2^n by the exponent's bits.
template <class N, int bytes>
Lanes<N, bytes> exp_of(const Lanes<N, bytes>& a) noexcept {
  using F = LaneFormat<N>;
  using Vector = typename Lanes<N, bytes>::Vector;
  using Bits = typename Lanes<N, bytes>::Bits;
  constexpr double kInverse[] = {1.0,           1.0,           0.5,           1.0 / 6.0,      1.0 / 24.0,      1.0 / 120.0,      1.0 / 720.0,
                                 1.0 / 5040.0,  1.0 / 40320.0, 1.0 / 362880.0, 1.0 / 3628800.0, 1.0 / 39916800.0, 1.0 / 479001600.0, 1.0 / 6227020800.0};
  const Vector shifted = a.v * static_cast<N>(1.4426950408889634) + F::kShift;
  const Vector n = shifted - F::kShift;
  const Vector r = (a.v - n * F::kLn2High) - n * F::kLn2Low;
  Vector s = Vector{} + static_cast<N>(kInverse[F::kTerms]);
  for (int k = F::kTerms - 1; k >= 0; --k) s = s * r + static_cast<N>(kInverse[k]);
  Bits bits;
  std::memcpy(&bits, &shifted, sizeof bits);
  bits = (bits << F::kFraction) + (typename F::Bit{F::kBias} << F::kFraction);
  Vector power;
  std::memcpy(&power, &bits, sizeof power);
  return Lanes<N, bytes>(s * power);
}

}  // namespace filum
