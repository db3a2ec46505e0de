#include "training/metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace filum {
namespace metrics_test {

std::vector<double> sampled(double begin, double end, double fs, double (*f)(double)) {
  std::vector<double> x;
  const int n = static_cast<int>(std::lround((end - begin) * fs));
  for (int k = 0; k < n; ++k) x.push_back(f(begin + k / fs));
  return x;
}

double bell(double t) {
  return std::exp(-5.0 * t * t);
}
double minimum_jerk_speed(double t) {
  return 30.0 * t * t * (1.0 - t) * (1.0 - t);
}
double sine(double t) {
  return std::sin(2.0 * std::numbers::pi * 3.0 * t);
}

// Values of the authors' program for exp(-5 t^2), t in [-1, 1), 100 Hz.
TEST(Metrics, SparcAndLdljOfTheAuthorsExample) {
  const std::vector<double> speed = sampled(-1.0, 1.0, 100.0, bell);
  EXPECT_NEAR(sparc(speed, 100.0), -1.41403, 5e-6);
  EXPECT_NEAR(ldlj(speed, 100.0), -5.81636, 5e-6);
}

TEST(Metrics, SparcAndLdljOfAMinimumJerkMove) {
  const std::vector<double> speed = sampled(0.0, 1.0, 1000.0, minimum_jerk_speed);
  EXPECT_NEAR(sparc(speed, 1000.0), -1.406, 5e-3);
  EXPECT_NEAR(ldlj(speed, 1000.0), -5.31, 0.01);
  const std::vector<double> fine = sampled(0.0, 1.0, 10000.0, minimum_jerk_speed);
  EXPECT_NEAR(ldlj(fine, 10000.0), -std::log(204.8), 1e-3);  // closed form
}

TEST(Metrics, SmoothnessDoesNotDependOnSizeOrUnit) {
  const std::vector<double> speed = sampled(-1.0, 1.0, 100.0, bell);
  std::vector<double> small = speed;
  for (double& v : small) v *= 1e-3;
  EXPECT_NEAR(sparc(small, 100.0), sparc(speed, 100.0), 1e-12);
  EXPECT_NEAR(ldlj(small, 100.0), ldlj(speed, 100.0), 1e-12);
}

TEST(Metrics, TremorMakesAMoveLessSmooth) {
  std::vector<double> speed = sampled(0.0, 1.0, 100.0, minimum_jerk_speed);
  const double calm_sparc = sparc(speed, 100.0), calm_ldlj = ldlj(speed, 100.0);
  for (std::size_t k = 0; k < speed.size(); ++k)
    speed[k] += 0.3 * std::sin(0.06 * 2.0 * std::numbers::pi * static_cast<double>(k));
  EXPECT_LT(sparc(speed, 100.0), calm_sparc - 0.1);
  EXPECT_LT(ldlj(speed, 100.0), calm_ldlj - 0.5);
}

TEST(Metrics, SmoothnessOfNothingIsNotANumber) {
  EXPECT_TRUE(std::isnan(sparc({}, 100.0)));
  EXPECT_TRUE(std::isnan(sparc(std::vector<double>(50, 0.0), 100.0)));
  EXPECT_TRUE(std::isnan(ldlj(std::vector<double>(50, 0.0), 100.0)));
}

TEST(Metrics, LowPassIsMinusThreeDecibelAtItsCutOffAndHasNoDelay) {
  const double fs = 1000.0;
  std::vector<double> x = sampled(0.0, 4.0, fs, sine);
  const std::vector<double> y = low_pass(x, fs, 3.0);
  double peak = 0.0;
  for (std::size_t k = 1000; k < 3000; ++k) peak = std::max(peak, y[k]);
  EXPECT_NEAR(peak, std::sqrt(0.5), 2e-3);
  EXPECT_NEAR(y[2000], 0.0, 2e-3);  // still in phase
  const std::vector<double> passed = low_pass(x, fs, 60.0);
  for (std::size_t k = 1000; k < 3000; ++k) EXPECT_NEAR(passed[k], x[k], 1e-3);
  const std::vector<double> constant = low_pass(std::vector<double>(100, 2.5), 100.0, 10.0);
  for (double v : constant) EXPECT_NEAR(v, 2.5, 1e-12);
}

/// Minimum-jerk moves of 10 mm in 1 s along x with rests of 1 s between.
Points moves(int n) {
  Points path(3, 200 * n + 100);
  path.setZero();
  for (Eigen::Index k = 0; k < path.cols(); ++k) {
    const double t = static_cast<double>(k) / 100.0 - 1.0;
    const int done = t < 0 ? 0 : std::min(n, static_cast<int>(t / 2.0));
    const double s = t < 0 || done == n ? 0.0 : std::min(1.0, t - 2.0 * done);
    path(0, k) = 0.01 * (done + s * s * s * (10.0 - 15.0 * s + 6.0 * s * s));
  }
  return path;
}

TEST(Metrics, CountsMovesMeasuresPathAndRest) {
  const Points path = moves(4);
  EXPECT_NEAR(path_length(path), 0.04, 1e-12);
  const std::vector<double> speed = speed_of(path, 100.0);
  const std::vector<Segment> found = movements(speed, 100.0);
  EXPECT_EQ(found.size(), 4u);
  // 9 s in all, four moves of which each is above 2 mm/s for 0.72 s (0.3 s^2 (1-s)^2 > 0.002).
  EXPECT_NEAR(idle_time(speed, 100.0), 9.0 - 4 * 0.80, 0.3);
  const Smoothness smooth = smoothness_of(speed, 100.0, found);
  EXPECT_EQ(smooth.sparc.n, 4);
  EXPECT_NEAR(smooth.sparc.median, -1.46,
              0.10);  // -1.41 for the whole move; its slow ends are cut off at the rest speed
  EXPECT_LT(smooth.ldlj.median, -4.0);
  EXPECT_GT(smooth.ldlj.median, -6.5);
}

TEST(Metrics, NoLdljFromQuantisedPositions) {
  // 55 um steps, as of a coarse encoder: SPARC hardly moves, LDLJ would be meaningless and is refused.
  Points path = moves(2);
  for (Eigen::Index k = 0; k < path.cols(); ++k) path(0, k) = 55e-6 * std::round(path(0, k) / 55e-6);
  const std::vector<double> speed = speed_of(path, 100.0);
  const std::vector<Segment> found = movements(speed, 100.0);
  ASSERT_EQ(found.size(), 2u);
  const Smoothness smooth = smoothness_of(speed, 100.0, found);
  EXPECT_EQ(smooth.sparc.n, 2);
  EXPECT_NEAR(smooth.sparc.median, -1.46, 0.15);
  EXPECT_EQ(smooth.ldlj.n, 0);
}

TEST(Metrics, SmallShakesAreNoMovements) {
  Points path = Points::Zero(3, 500);
  for (Eigen::Index k = 0; k < 500; ++k)
    path(1, k) = 25e-6 * std::sin(2.0 * std::numbers::pi * 10.0 * static_cast<double>(k) / 100.0);
  EXPECT_TRUE(movements(speed_of(path, 100.0), 100.0).empty());
}

/// A recording whose poses are not numbers was looked through without end.
TEST(Metrics, WhatIsNotANumberIsNoMovement) { EXPECT_TRUE(movements(std::vector<double>(500, std::nan("")), 100.0).empty()); }

TEST(Metrics, BimanualLagAndDominance) {
  const Points first = moves(4);
  Points second = first;
  for (Eigen::Index k = 0; k < second.cols(); ++k)
    second.col(k) = 3.0 * first.col(std::max<Eigen::Index>(0, k - 20));
  const Bimanual both = bimanual(first, second, 100.0);
  EXPECT_NEAR(both.lag, 0.20, 0.011);
  EXPECT_GT(both.correlation, 0.99);
  EXPECT_NEAR(both.dominance, 0.75, 1e-3);
  EXPECT_GT(both.both_moving, 0.2);
  EXPECT_LT(both.both_moving, 0.4);
  const Bimanual alone = bimanual(first, Points::Zero(3, first.cols()), 100.0);
  EXPECT_EQ(alone.both_moving, 0.0);
  EXPECT_EQ(alone.dominance, 0.0);
  EXPECT_TRUE(std::isnan(alone.correlation));
}

TEST(Metrics, ForcePeaks) {
  const std::vector<double> peaks = force_peaks({0, 0.2, 0.5, 0.3, 0, 0.05, 0, 0.4, 0.4}, 0.1);
  ASSERT_EQ(peaks.size(), 2u);
  EXPECT_EQ(peaks[0], 0.5);
  EXPECT_EQ(peaks[1], 0.4);
}

TEST(Metrics, Quartiles) {
  const Spread s = spread_of({5, 1, std::nan(""), 3, 2, 4});
  EXPECT_EQ(s.n, 5);
  EXPECT_EQ(s.median, 3);
  EXPECT_EQ(s.low, 2);
  EXPECT_EQ(s.high, 4);
  EXPECT_TRUE(std::isnan(spread_of({}).median));
}

}  // namespace metrics_test
}  // namespace filum
