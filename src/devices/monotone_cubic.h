#pragma once
// Piecewise cubic Hermite interpolation that never overshoots: F. N. Fritsch and R. E. Carlson, "Monotone
// piecewise cubic interpolation", SIAM J. Numer. Anal. 17 (1980) 238-246, with the weighted harmonic mean of
// F. N. Fritsch and J. Butland, SIAM J. Sci. Stat. Comput. 5 (1984) 300-304, which needs no second pass over
// the slopes.

#include <vector>

namespace filum {

/// Slopes at the knots [value/s]. Zero at both ends, wherever `rest[i]` is set and wherever the data turn
/// round, so equal neighbours hold still. `times` must grow strictly; all three have the same size.
std::vector<double> monotone_slopes(const std::vector<double>& times, const std::vector<double>& values,
                                    const std::vector<bool>& rest);

/// Cubic on one interval: values y0, y1 and slopes m0, m1 at its ends, h its length [s], u in [0, 1] the
/// place in it.
double hermite(double y0, double y1, double m0, double m1, double h, double u) noexcept;

}  // namespace filum
