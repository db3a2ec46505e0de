#pragma once
// Softening of the first cycles: an element's stress is scaled by 1 - d s((Wmax - W)/W0), W its energy per volume and Wmax the most it has had
// (pseudo-elasticity: Ogden & Roxburgh, Proc. R. Soc. A 455:2861, 1999; in arteries: Weisbecker et al., J. Mech. Behav. Biomed. Mater. 12:93, 2012). Along
// a way that it has not gone before it is as firm as ever. Neglects: recovery at rest, set, that fibres and ground soften differently.
// Test: tube_slice_test.

#include <cmath>

namespace filum {

struct WallSoftening {
  enum class Shape { exponential, error_function, fraction };
  Shape shape = Shape::exponential;
  double d = 0.0;   // [-], 0 to 1
  double W0 = 1.0;  // [J/m3]

  /// Share of the stress that is left.
  double left(double W, double Wmax) const noexcept {
    const double x = Wmax > W ? (Wmax - W) / W0 : 0.0;
    return 1.0 - d * (shape == Shape::exponential ? -std::expm1(-x) : shape == Shape::error_function ? std::erf(x) : x / (1.0 + x));
  }
};

}  // namespace filum
