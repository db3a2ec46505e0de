// Wire that keeps a bend: elastic_rod_test.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "physics/elastic_rod.h"

namespace filum {
namespace rod_yield_test {

/// E I kappa = the moment of a round section yielded throughout, int sigma_y |y| dA, summed over strips of the section.
TEST(RodYield, CurvatureIsThatOfASectionYieldedThroughout) {
  const double radius = 25e-6, yield_strain = 0.02;
  constexpr int kStrips = 20000;
  double moment = 0.0;  // over E
  for (int k = 0; k < kStrips; ++k) {
    const double y = radius * (k + 0.5) / kStrips;
    moment += 2.0 * yield_strain * y * 2.0 * std::sqrt(radius * radius - y * y) * radius / kStrips;
  }
  const double I = 0.25 * std::numbers::pi * std::pow(radius, 4);
  EXPECT_NEAR(most_elastic_curvature(yield_strain, radius) * I / moment, 1.0, 1e-6);
}

}  // namespace rod_yield_test
}  // namespace filum
