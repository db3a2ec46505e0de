#include "analysis/spectrum.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace filum {
namespace spectrum_test {

constexpr double kFs = 200.0;  // [Hz]

std::vector<double> noise(std::size_t n, unsigned seed, double sigma) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0.0, sigma);
  std::vector<double> x(n);
  for (double& v : x) v = normal(random);
  return x;
}

TEST(Spectrum, WhiteNoiseHasItsClosedForm) {
  const double sigma = 3.0;
  const Spectrum s = welch({noise(200'000, 1, sigma)}, kFs);
  // One-sided density of white noise is 2 sigma^2 / fs.
  const double expected = 2.0 * sigma * sigma / kFs;
  EXPECT_NEAR(band_power(s, 8.0, 12.0).value, 4.0 * expected, 0.05 * 4.0 * expected);
  EXPECT_NEAR(band_power(s, 0.0, 100.0).value, sigma * sigma, 0.01 * sigma * sigma);
  EXPECT_EQ(s.segments, 499.0);
}

TEST(Spectrum, ToneGivesItsPowerFrequencyAndTheWindowsWidth) {
  const double amplitude = 25e-6, f = 9.13;
  std::vector<double> x(12'000);
  for (std::size_t k = 0; k < x.size(); ++k)
    x[k] = amplitude * std::sin(2.0 * std::numbers::pi * f * static_cast<double>(k) / kFs + 0.4);
  const Spectrum s = welch({x}, kFs);
  EXPECT_NEAR(band_power(s, 8.0, 12.0).value, 0.5 * amplitude * amplitude, 1e-3 * amplitude * amplitude);
  const SpectralPeak peak = peak_between(s, 4.0, 20.0);
  EXPECT_NEAR(peak.frequency, f, 0.1 * s.df);
  EXPECT_NEAR(peak.half_width, s.resolution(), 0.25 * s.resolution());  // four bins wide at most
  EXPECT_TRUE(peak.narrow);
}

TEST(Spectrum, BroadPeakHasTheHalfPowerWidthOfItsResonance) {
  // x_k = 2 r cos(w) x_{k-1} - r^2 x_{k-2} + e: a resonance whose half-power width is (1 - r) fs / pi.
  const double width = 2.0, f = 9.0, r = 1.0 - std::numbers::pi * width / kFs;
  const double c = 2.0 * r * std::cos(2.0 * std::numbers::pi * f / kFs);
  std::vector<double> x = noise(400'000, 2, 1.0);
  for (std::size_t k = 2; k < x.size(); ++k) x[k] += c * x[k - 1] - r * r * x[k - 2];
  const SpectralPeak peak = peak_between(welch({x}, kFs), 4.0, 20.0);
  EXPECT_NEAR(peak.frequency, f, 0.3);
  EXPECT_NEAR(peak.half_width, width, 0.25 * width);
  EXPECT_FALSE(peak.narrow);
}

TEST(Spectrum, IntervalsCoverTheTruthAsOftenAsTheySay) {
  int covered = 0;
  constexpr int kRuns = 400;
  for (int run = 0; run < kRuns; ++run) {
    const Interval band = band_power(welch({noise(4000, 100 + static_cast<unsigned>(run), 1.0)}, kFs), 8.0, 12.0);
    const double truth = 4.0 * 2.0 / kFs;
    covered += band.low < truth && truth < band.high ? 1 : 0;
  }
  EXPECT_GT(covered, 0.91 * kRuns);
  EXPECT_LT(covered, 0.99 * kRuns);
}

TEST(Spectrum, NoSegmentSpansAGap) {
  const std::vector<double> a(700, 1.0), b(700, -1.0);  // a step between the two would be power at all frequencies
  EXPECT_EQ(welch({a, b}, kFs).segments, 0.0);
  const std::vector<double> c(900, 1.0), d(900, -1.0);
  const Spectrum s = welch({c, d}, kFs);
  EXPECT_EQ(s.segments, 2.0);
  EXPECT_LT(band_power(s, 1.0, 100.0).value, 1e-20);
}

TEST(Spectrum, SlowDriftLeavesTheTremorBandsAlone) {
  std::vector<double> x(12'000);
  for (std::size_t k = 0; k < x.size(); ++k) x[k] = 1e-3 * static_cast<double>(k) / kFs;  // 1 mm/s
  EXPECT_LT(std::sqrt(band_power(welch({x}, kFs), 4.0, 20.0).value), 1e-12);
}

TEST(Spectrum, ParsevalHoldsForASumOfAxes) {
  const Spectrum x = welch({noise(8000, 5, 1.0)}, kFs), y = welch({noise(8000, 6, 2.0)}, kFs);
  const Spectrum sum = sum_of({x, y});
  EXPECT_NEAR(band_power(sum, 0.0, 100.0).value, band_power(x, 0.0, 100.0).value + band_power(y, 0.0, 100.0).value, 1e-9);
}

}  // namespace spectrum_test
}  // namespace filum
