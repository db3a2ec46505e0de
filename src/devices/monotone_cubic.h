#pragma once
// Piecewise cubic Hermite interpolation that never overshoots: F. N. Fritsch and R. E. Carlson, "Monotone
// piecewise cubic interpolation", SIAM J. Numer. Anal. 17 (1980) 238-246, with the weighted harmonic mean of
// F. N. Fritsch and J. Butland, SIAM J. Sci. Stat. Comput. 5 (1984) 300-304, which needs no second pass over
// the slopes.

namespace filum {

/// Slope at an inner knot [value/s] from the distances h0, h1 [s] and the rates of change d0, d1 [value/s] before and after it. Zero where the
/// data turn round, so equal neighbours hold still; the ends, and knots that are to be at rest, have none.
double monotone_slope(double h0, double h1, double d0, double d1) noexcept;

/// Cubic on one interval: values y0, y1 and slopes m0, m1 at its ends, h its length [s], u in [0, 1] the
/// place in it.
double hermite(double y0, double y1, double m0, double m1, double h, double u) noexcept;

}  // namespace filum
