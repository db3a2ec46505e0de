#include "devices/monotone_cubic.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace filum {
namespace monotone_cubic_test {

double value_at(const std::vector<double>& t, const std::vector<double>& y, const std::vector<double>& m,
                std::size_t i, double u) {
  return hermite(y[i], y[i + 1], m[i], m[i + 1], t[i + 1] - t[i], u);
}

/// Slopes at all knots, as a track makes them.
std::vector<double> monotone_slopes(const std::vector<double>& t, const std::vector<double>& y, const std::vector<bool>& rest) {
  std::vector<double> slopes(t.size(), 0.0);
  for (std::size_t i = 1; i + 1 < t.size(); ++i) {
    const double h0 = t[i] - t[i - 1], h1 = t[i + 1] - t[i];
    if (!rest[i]) slopes[i] = monotone_slope(h0, h1, (y[i] - y[i - 1]) / h0, (y[i + 1] - y[i]) / h1);
  }
  return slopes;
}

TEST(MonotoneCubic, StaysBetweenItsKnotsForRandomData) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> value(-1.0, 1.0), step(0.01, 2.0);
  for (int trial = 0; trial < 300; ++trial) {
    std::vector<double> t{0.0}, y{value(random)};
    for (int k = 0; k < 12; ++k) {
      t.push_back(t.back() + step(random));
      y.push_back(value(random));
    }
    const auto m = monotone_slopes(t, y, std::vector<bool>(t.size(), false));
    for (std::size_t i = 0; i + 1 < t.size(); ++i) {
      const double low = std::min(y[i], y[i + 1]), high = std::max(y[i], y[i + 1]);
      double last = y[i];
      for (int s = 1; s <= 50; ++s) {
        const double now = value_at(t, y, m, i, s / 50.0);
        ASSERT_GE(now, low - 1e-12);
        ASSERT_LE(now, high + 1e-12);
        ASSERT_GE((now - last) * (y[i + 1] - y[i]), -1e-12) << "turned back inside an interval";
        last = now;
      }
    }
  }
}

TEST(MonotoneCubic, HoldsExactlyBetweenEqualKnots) {
  const std::vector<double> t{0, 1, 2, 5}, y{0.3, 0.7, 0.7, 0.1};
  const auto m = monotone_slopes(t, y, std::vector<bool>(4, false));
  for (int s = 0; s <= 20; ++s) EXPECT_EQ(value_at(t, y, m, 1, s / 20.0), 0.7);
}

TEST(MonotoneCubic, ReproducesALineInsideAndRestsAtTheEnds) {
  const std::vector<double> t{0, 1, 3, 4, 6}, y{0, 2, 6, 8, 12};
  const auto m = monotone_slopes(t, y, std::vector<bool>(5, false));
  EXPECT_EQ(m.front(), 0.0);
  EXPECT_EQ(m.back(), 0.0);
  for (std::size_t i = 1; i < 4; ++i) EXPECT_NEAR(m[i], 2.0, 1e-14);
  EXPECT_NEAR(value_at(t, y, m, 1, 0.25), 3.0, 1e-14);
}

TEST(MonotoneCubic, RestForcesZeroSlope) {
  const std::vector<double> t{0, 1, 2}, y{0, 1, 2};
  EXPECT_GT(monotone_slopes(t, y, {false, false, false})[1], 0.5);
  EXPECT_EQ(monotone_slopes(t, y, {false, true, false})[1], 0.0);
}

// On a smooth monotone function the interior error falls at least with h^2 (the harmonic mean is second
// order).
TEST(MonotoneCubic, ConvergesOnASmoothFunction) {
  double last_error = 0.0;
  for (int n : {16, 32, 64, 128}) {
    std::vector<double> t, y;
    for (int i = 0; i <= n; ++i) {
      t.push_back(2.0 * i / n);
      y.push_back(std::exp(t.back()));
    }
    const auto m = monotone_slopes(t, y, std::vector<bool>(t.size(), false));
    double error = 0.0;
    for (std::size_t i = 2; i + 3 < t.size(); ++i) {
      const double middle = 0.5 * (t[i] + t[i + 1]);
      error = std::max(error, std::abs(value_at(t, y, m, i, 0.5) - std::exp(middle)));
    }
    if (last_error > 0.0) {
      EXPECT_GT(std::log2(last_error / error), 1.9) << "n = " << n;
    }
    last_error = error;
  }
}

}  // namespace monotone_cubic_test
}  // namespace filum
