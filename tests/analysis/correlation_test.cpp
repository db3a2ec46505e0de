#include "analysis/correlation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace filum {
namespace correlation_test {

TEST(Correlation, AgreesWithWorkedNumbers) {
  // r of these five pairs is 0.774597 (= sqrt(0.6)), slope 0.6; ranks with a tie: rho = 0.737865.
  const Correlation c = correlate({1, 2, 3, 4, 5}, {2, 4, 5, 4, 5});
  EXPECT_NEAR(c.r, std::sqrt(0.6), 1e-12);
  EXPECT_NEAR(c.slope, 0.6, 1e-12);
  EXPECT_NEAR(c.rank, 0.7378648, 1e-6);
  // Fisher: tanh(atanh(r) -+ 1.959964 / sqrt(2)).
  EXPECT_NEAR(c.low, std::tanh(std::atanh(std::sqrt(0.6)) - 1.959963984540054 / std::sqrt(2.0)), 1e-12);
}

TEST(Correlation, IntervalCoversTheTruth) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  const double rho = 0.5;
  int covered = 0;
  for (int run = 0; run < 500; ++run) {
    std::vector<double> x, y;
    for (int k = 0; k < 30; ++k) {
      x.push_back(normal(random));
      y.push_back(rho * x.back() + std::sqrt(1.0 - rho * rho) * normal(random));
    }
    const Correlation c = correlate(x, y);
    covered += c.low < rho && rho < c.high ? 1 : 0;
  }
  EXPECT_GT(covered, 460);
  EXPECT_LT(covered, 492);
}

TEST(Correlation, WithinSessionsIsNotFooledBySessionMeans) {
  // Within each session y falls with x; across sessions both rise together (Simpson's paradox).
  std::vector<PairGroup> groups;
  std::vector<double> mean_x, mean_y;
  for (int s = 0; s < 5; ++s) {
    PairGroup g;
    for (int k = -5; k <= 5; ++k) {
      g.x.push_back(10.0 * s + k);
      g.y.push_back(10.0 * s - 0.5 * k + (k % 2 == 0 ? 0.1 : -0.1));
    }
    groups.push_back(g);
    mean_x.push_back(10.0 * s);
    mean_y.push_back(10.0 * s);
  }
  const Correlation within = correlate_within(groups);
  EXPECT_LT(within.r, -0.99);
  EXPECT_NEAR(within.slope, -0.5, 0.01);
  EXPECT_EQ(within.groups, 5);
  EXPECT_GT(correlate(mean_x, mean_y).r, 0.999);
}

TEST(Correlation, RefusesWithItsReason) {
  EXPECT_EQ(correlate({1, 2, 3}, {1, 2, 3}).why, "fewer than 4 pairs");
  const Correlation flat = correlate({1, 1, 1, 1}, {1, 2, 3, 4});
  EXPECT_TRUE(std::isnan(flat.r));
  EXPECT_FALSE(flat.why.empty());
  EXPECT_FALSE(correlate_within({}).why.empty());
}

}  // namespace correlation_test
}  // namespace filum
