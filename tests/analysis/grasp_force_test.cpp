#include "analysis/grasp_force.h"

#include <gtest/gtest.h>

#include <cmath>

namespace filum {
namespace grasp_force_test {

constexpr double kFs = 1000.0;

/// Rises at 2 N/s to 0.5 N, settles to 0.4 N with a ripple, lets go.
std::vector<double> one_grasp(double ripple = 0.0) {
  std::vector<double> f(3000, 0.0);
  for (std::size_t k = 500; k < 2500; ++k) {
    const double t = static_cast<double>(k - 500) / kFs;
    f[k] = t < 0.25 ? 2.0 * t : t < 0.35 ? 0.5 - (t - 0.25) : 0.4 + ripple * std::sin(2.0 * M_PI * 5.0 * t);
  }
  return f;
}

TEST(GraspForce, OneGraspHasItsClosedForm) {
  const std::vector<Grasp> grasps = find_grasps(one_grasp(0.04), kFs, 10.0, {});
  ASSERT_EQ(grasps.size(), 1u);
  const Grasp& g = grasps.front();
  EXPECT_NEAR(g.from, 10.51, 2e-3);  // where 2 N/s crosses 20 mN
  EXPECT_NEAR(g.to, 12.5, 2e-3);
  EXPECT_NEAR(g.peak, 0.5, 1e-9);
  EXPECT_NEAR(g.plateau, 0.4, 2e-3);
  EXPECT_NEAR(g.overshoot, 0.1, 2e-3);
  EXPECT_NEAR(g.rise, 2.0, 0.15);  // the filter overshoots by some per cent
  EXPECT_NEAR(g.variation, 0.1 / std::sqrt(2.0), 3e-3);  // ripple of a tenth
  EXPECT_FALSE(g.excess.has_value());
}

TEST(GraspForce, ExcessIsOverWhatHoldsTheObject) {
  const std::vector<Grasp> grasps = find_grasps(one_grasp(), kFs, 0.0, {{0.6, 2.4, 0.15, true}, {9.0, 9.5, 0.3, false}});
  ASSERT_EQ(grasps.size(), 1u);
  ASSERT_TRUE(grasps[0].excess.has_value());
  EXPECT_NEAR(*grasps[0].excess, 0.25, 1e-3);
  EXPECT_TRUE(grasps[0].slipped);
}

TEST(GraspForce, ShortTouchesAndSilenceAreNoGrasps) {
  std::vector<double> f(2000, 0.0);
  for (std::size_t k = 900; k < 950; ++k) f[k] = 0.3;
  EXPECT_TRUE(find_grasps(f, kFs, 0.0, {}).empty());
  EXPECT_TRUE(find_grasps({}, kFs, 0.0, {}).empty());
}

TEST(GraspForce, ErrorsAreAgainstTheExpertsBands) {
  std::vector<Grasp> experts;
  for (int i = 0; i <= 100; ++i) {
    Grasp g;
    g.peak = 0.2 + 0.002 * i;
    g.variation = 0.001 * i;
    experts.push_back(g);
  }
  const GraspBands bands = bands_of(experts);
  EXPECT_NEAR(bands.peak_low, 0.21, 1e-12);
  EXPECT_NEAR(bands.peak_high, 0.39, 1e-12);
  EXPECT_NEAR(bands.variation_high, 0.095, 1e-12);
  std::vector<Grasp> novice(4);
  novice[0].peak = 0.6;                           // high
  novice[1].peak = 0.1;                           // weak, but nothing slipped
  novice[2].peak = 0.1, novice[2].slipped = true; // low
  novice[3].peak = 0.3, novice[3].variation = 0.3;
  const GraspErrors errors = errors_of(novice, bands);
  EXPECT_EQ(errors.high, 1);
  EXPECT_EQ(errors.low, 1);
  EXPECT_EQ(errors.variable, 1);
}

}  // namespace grasp_force_test
}  // namespace filum
