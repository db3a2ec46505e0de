#include "reconcile/transform.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/rng.h"

namespace filum::reconcile {
namespace transform_test {

TEST(Transform, OnlyLongRecordsOfUnluckyLengthsLoseTheirLastSamples) {
  for (const int n : {64, 3750, 4447, 45000, 60000, 131072}) EXPECT_EQ(transformed_length(n), n) << n;  // 4447 is prime
  for (const int n : {59999, 1999993}) {                                                                // prime
    EXPECT_LT(transformed_length(n), n);
    EXPECT_GT(transformed_length(n), 0.97 * n);
  }
}

TEST(Transform, ASineStandsInItsOwnBin) {
  const int n = 59999;
  const auto used = static_cast<double>(transformed_length(n));
  Eigen::VectorXd v(n);
  for (Eigen::Index k = 0; k < n; ++k) v[k] = std::cos(2.0 * std::numbers::pi * 100.0 * static_cast<double>(k) / used);
  v[7] = NAN;  // missing
  const auto out = transform(v);
  ASSERT_EQ(static_cast<double>(out.size()), used);
  EXPECT_NEAR(std::abs(out[100]), 0.5 * used, 2.0);
  EXPECT_LT(std::abs(out[101]), 2.0);
}

/// Against the sum itself: a sine of amplitude A takes n A^2/2 off the squares at its frequency. The clock jitters and stands still for a minute, a sample in ten
/// is missing, and a ten times stronger sine well outside the band leaks no more than it does in the sum.
TEST(Transform, LinePowersAreThoseOfASumAtEachFrequency) {
  Rng rng(5);
  const int n = 30000;
  Eigen::VectorXd time(n), v(n);
  double t = 0.0, there = 0.0;
  for (Eigen::Index k = 0; k < n; ++k) {
    t += 0.01 * (1.0 + 0.3 * (rng.uniform() - 0.5)) + (k == 9000 ? 60.0 : 0.0);
    time[k] = t;
    v[k] = rng.uniform() < 0.1 ? NAN : 2.0 * std::sin(2.0 * std::numbers::pi * 1.2345 * t + 0.3) + 20.0 * std::sin(2.0 * std::numbers::pi * 9.1 * t) + rng.normal();
    there += std::isfinite(v[k]) ? 1.0 : 0.0;
  }
  std::vector<double> frequency, sum;
  for (double f = 0.7; f <= 2.2; f += 0.3 / (time[n - 1] - time[0])) frequency.push_back(f);
  const auto power = line_powers(time, v, frequency);
  ASSERT_EQ(power.size(), frequency.size());
  double most = 0.0;
  for (std::size_t i = 0; i < frequency.size(); ++i) {
    std::complex<double> s = 0.0;
    for (Eigen::Index k = 0; k < n; ++k)
      if (std::isfinite(v[k])) s += std::polar(v[k], -2.0 * std::numbers::pi * frequency[i] * (time[k] - time[0]));
    sum.push_back(2.0 * std::norm(s) / there);
    most = std::max(most, sum.back());
  }
  EXPECT_NEAR(most / (2.0 * there), 1.0, 0.2);  // the grid of frequencies misses the sine by a little
  for (std::size_t i = 0; i < frequency.size(); ++i) EXPECT_NEAR(std::sqrt(power[i]), std::sqrt(sum[i]), 0.05 * std::sqrt(most)) << frequency[i];
}

}  // namespace transform_test
}  // namespace filum::reconcile
