#include "physics/vessel_wall_lanes.h"

#include <gtest/gtest.h>

using namespace filum;

namespace vessel_wall_lanes_test {

template <class N>
double worst_exp() {
  double worst = 0.0;
  for (double x = -30.0; x < 30.0; x += 0.0173) {
    Lanes<N> a(0.0);
    for (int k = 0; k < Lanes<N>::kWidth; ++k) a.set(k, x + 0.001 * k);
    const Lanes<N> e = exp_of(a);
    for (int k = 0; k < Lanes<N>::kWidth; ++k) worst = std::max(worst, std::abs(e[k] / std::exp(static_cast<double>(a[k])) - 1.0));
  }
  return worst;
}

TEST(VesselWallLanes, Exponential) {
  EXPECT_LT(worst_exp<double>(), 1e-15);
  EXPECT_LT(worst_exp<float>(), 1e-6);
}

TEST(VesselWallLanes, LanesAreIndependent) {
  Lanes<double> a(0.0);
  for (int k = 0; k < 4; ++k) a.set(k, k - 1.0);
  EXPECT_EQ(positive_part(a)[0], 0.0);
  EXPECT_EQ(positive_part(a)[3], 2.0);
  EXPECT_EQ(least_of(a, Lanes<double>(0.5))[2], 0.5);
  EXPECT_EQ((a * a + 1.0)[3], 5.0);
  EXPECT_DOUBLE_EQ(root_of(a * a)[3], 2.0);
}

}  // namespace vessel_wall_lanes_test
