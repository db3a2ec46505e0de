#include "devices/monotone_cubic.h"

namespace filum {

double monotone_slope(double h0, double h1, double d0, double d1) noexcept {
  const bool same_sign = (d0 > 0.0 && d1 > 0.0) || (d0 < 0.0 && d1 < 0.0);
  if (!same_sign) return 0.0;
  const double w0 = 2.0 * h1 + h0, w1 = h1 + 2.0 * h0;
  return (w0 + w1) / (w0 / d0 + w1 / d1);
}

double hermite(double y0, double y1, double m0, double m1, double h, double u) noexcept {
  if (y0 == y1 && m0 == 0.0 && m1 == 0.0) return y0;  // hold exactly, not to rounding
  const double u2 = u * u, u3 = u2 * u;
  const double blend = 3.0 * u2 - 2.0 * u3;
  return y0 + (y1 - y0) * blend + h * (m0 * (u3 - 2.0 * u2 + u) + m1 * (u3 - u2));
}

}  // namespace filum
