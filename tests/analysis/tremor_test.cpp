#include "analysis/tremor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace filum {
namespace tremor_test {

constexpr double kTurn = 2.0 * std::numbers::pi;

/// 40 s at 500 Hz: a tone [m] along x, white noise [m] on each axis, a slow wander of 0.2 mm.
EvenPath path_with(double amplitude, double f, double sigma, unsigned seed, double fs = 500.0, double seconds = 40.0) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0.0, sigma);
  const auto n = static_cast<Eigen::Index>(seconds * fs);
  Points p(3, n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const double t = static_cast<double>(k) / fs;
    const double slow = 0.2e-3 * std::sin(kTurn * 0.1 * t);
    p.col(k) = Vec3(amplitude * std::sin(kTurn * f * t) + slow, slow, 0.0);
    if (sigma > 0.0) p.col(k) += Vec3(normal(random), normal(random), normal(random));
  }
  return {fs, {p}, 0.0, 0};
}

TEST(Tremor, ToneIsFoundInItsBandWithItsRms) {
  const double amplitude = 50e-6;
  const Tremor t = tremor_of(path_with(amplitude, 9.0, 0.2e-6, 1), path_with(0.0, 9.0, 0.2e-6, 2));
  ASSERT_TRUE(t.measured) << t.why;
  ASSERT_EQ(t.bands.size(), 4u);
  EXPECT_NEAR(t.peak.frequency, 9.0, 0.02);
  for (int i : {1, 2}) {
    const TremorBand& band = t.bands[static_cast<std::size_t>(i)];
    EXPECT_TRUE(band.resolved) << band.why;
    EXPECT_NEAR(band.rms, amplitude / std::numbers::sqrt2, 0.003 * amplitude);
  }
  EXPECT_NEAR(t.rms, amplitude / std::numbers::sqrt2, 0.02 * amplitude);
}

TEST(Tremor, TheHighPassTakesNothingFromTheLowestBand) {
  const double amplitude = 50e-6;
  const Tremor t = tremor_of(path_with(amplitude, 4.8, 0.1e-6, 1), path_with(0.0, 1.0, 0.1e-6, 2));
  EXPECT_NEAR(t.bands[0].rms, amplitude / std::numbers::sqrt2, 0.01 * amplitude);
}

TEST(Tremor, TheFloorIsTakenAwayInPower) {
  // Noise of 10 um on each axis at 500 Hz: 8-12 Hz holds 3 * 2 sigma^2 / fs * 4 Hz = (2.19 um)^2.
  const double sigma = 10e-6, amplitude = 6e-6;
  const Tremor t = tremor_of(path_with(amplitude, 10.0, sigma, 3, 500.0, 240.0), path_with(0.0, 1.0, sigma, 4, 500.0, 240.0));
  const TremorBand& band = t.bands[2];
  EXPECT_NEAR(std::sqrt(band.floor), std::sqrt(3.0 * 2.0 * sigma * sigma / 500.0 * 4.0), 0.2e-6);
  ASSERT_TRUE(band.resolved) << band.why;
  EXPECT_NEAR(band.rms, amplitude / std::numbers::sqrt2, 0.4e-6);
}

TEST(Tremor, RefusesWhatTheDeviceCannotResolve) {
  const Tremor t = tremor_of(path_with(2e-6, 9.0, 50e-6, 5), path_with(0.0, 9.0, 50e-6, 6));
  EXPECT_TRUE(t.measured);
  EXPECT_FALSE(t.resolved());
  for (const TremorBand& band : t.bands) {
    EXPECT_TRUE(std::isnan(band.rms));
    EXPECT_FALSE(band.why.empty());
  }
}

TEST(Tremor, RefusesWithoutANoiseFloor) {
  const Tremor t = tremor_of(path_with(50e-6, 9.0, 0.0, 7), std::nullopt);
  EXPECT_FALSE(t.resolved());
  EXPECT_NE(t.why.find("noise floor not measured"), std::string::npos);
}

TEST(Tremor, RefusesATrackerOfTwentyFramesASecond) {
  const Tremor t = tremor_of(path_with(50e-6, 9.0, 0.0, 8, 22.0), path_with(0.0, 9.0, 1e-9, 8, 22.0));
  EXPECT_FALSE(t.bands[2].resolved) << "8-12 Hz needs 30 Hz";
  EXPECT_NE(t.bands[2].why.find("too slowly"), std::string::npos);
}

TEST(Tremor, RefusesTooLittleAndTooIrregular) {
  EXPECT_FALSE(tremor_of(path_with(50e-6, 9.0, 0.0, 9, 500.0, 5.0), std::nullopt).measured);
  EvenPath irregular = path_with(50e-6, 9.0, 0.0, 9);
  irregular.jitter = 2e-3;
  EXPECT_NE(tremor_of(irregular, std::nullopt).why.find("jitter"), std::string::npos);
  EXPECT_FALSE(tremor_of(EvenPath{}, std::nullopt).measured);
}

TEST(Tremor, SlowVoluntaryMovementIsNoTremor) {
  const Tremor t = tremor_of(path_with(5e-3, 0.4, 0.0, 10), path_with(0.0, 9.0, 0.1e-6, 11));
  for (const TremorBand& band : t.bands) EXPECT_LT(std::sqrt(band.power.value), 0.3e-6);
}

TEST(EvenPath, GapsEndStretchesAndNothingIsFilledIn) {
  std::vector<double> t;
  for (int k = 0; k < 1000; ++k)
    if (k < 400 || k >= 450) t.push_back(1e-3 * k);
  Points p = Points::Zero(3, static_cast<Eigen::Index>(t.size()));
  for (Eigen::Index k = 0; k < p.cols(); ++k) p(0, k) = t[static_cast<std::size_t>(k)];
  const EvenPath even = even_path(t, p);
  EXPECT_EQ(even.gaps, 1u);
  ASSERT_EQ(even.stretches.size(), 2u);
  EXPECT_EQ(even.stretches[0].cols(), 400);
  EXPECT_EQ(even.stretches[1].cols(), 550);
  EXPECT_NEAR(even.fs, 1000.0, 1e-6);
  EXPECT_NEAR(even.stretches[1](0, 10), 0.460, 1e-9);
  EXPECT_EQ(even.starts, (std::vector<double>{t[0], t[400]}));
}

TEST(EvenPath, JitterIsMeasuredAndALineStaysALine) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-2e-4, 2e-4);
  std::vector<double> t;
  Points p(3, 2000);
  for (int k = 0; k < 2000; ++k) {
    t.push_back(1e-3 * k + uniform(random));
    p.col(k) = Vec3(2.0 * t.back(), 0.0, 1.0);
  }
  const EvenPath even = even_path(t, p);
  ASSERT_EQ(even.stretches.size(), 1u);
  EXPECT_NEAR(even.jitter, std::sqrt(2.0) * 2e-4 / std::sqrt(3.0), 2e-5);
  const Points& q = even.stretches[0];
  for (Eigen::Index k = 1; k + 1 < q.cols(); ++k) ASSERT_NEAR(q(0, k) - q(0, k - 1), 2.0 / even.fs, 1e-9);
}

}  // namespace tremor_test
}  // namespace filum
