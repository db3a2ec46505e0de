#pragma once
// Random numbers that are the same on every platform and library: the engine is fixed by the C++ standard,
// the distributions are our own (those of <random> differ between libraries).

#include <cmath>
#include <cstdint>
#include <random>

#include "base/pose.h"

namespace filum {

class Rng {
 public:
  explicit Rng(std::uint64_t seed = 1) : engine_(seed) {}

  std::uint64_t bits() { return engine_(); }

  /// Uniform in [0, 1), 53 bits.
  double uniform() { return static_cast<double>(engine_() >> 11) * 0x1.0p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }

  /// Uniform in 0 ... n-1 without bias; n >= 1.
  std::uint64_t below(std::uint64_t n) {
    const std::uint64_t limit = engine_.max() - engine_.max() % n;
    std::uint64_t draw = engine_();
    while (draw >= limit) draw = engine_();
    return draw % n;
  }

  /// Mean 0, variance 1 (Marsaglia's polar method; the second value is thrown away to keep the state one
  /// engine).
  double normal() {
    for (;;) {
      const double u = uniform(-1.0, 1.0);
      const double v = uniform(-1.0, 1.0);
      const double s = u * u + v * v;
      if (s > 0.0 && s < 1.0) return u * std::sqrt(-2.0 * std::log(s) / s);
    }
  }

  /// Uniform on the unit sphere.
  Vec3 direction() {
    for (;;) {
      const double x = uniform(-1.0, 1.0);
      const double y = uniform(-1.0, 1.0);
      const double z = uniform(-1.0, 1.0);
      const Vec3 v(x, y, z);
      const double n = v.squaredNorm();
      if (n > 1e-6 && n <= 1.0) return v / std::sqrt(n);
    }
  }

  /// Uniform over all rotations (Shoemake 1992).
  Quat rotation() {
    const double u = uniform();
    const double a = uniform(0.0, kTurn);
    const double b = uniform(0.0, kTurn);
    const double s = std::sqrt(1.0 - u);
    const double t = std::sqrt(u);
    return Quat(t * std::cos(b), s * std::sin(a), s * std::cos(a), t * std::sin(b));
  }

 private:
  static constexpr double kTurn = 6.283185307179586;  // [rad]

  std::mt19937_64 engine_;
};

}  // namespace filum
