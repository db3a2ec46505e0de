#include "haptics/period_stats.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace filum {
namespace period_stats_test {

TEST(PeriodStats, QuantilesAgreeWithSortingWithinABucket) {
  std::mt19937 random(6);
  std::gamma_distribution<double> period(4.0, 260.0);
  PeriodStats stats;
  std::vector<std::int64_t> all;
  for (int i = 0; i < 20'000; ++i) {
    all.push_back(static_cast<std::int64_t>(period(random)));
    stats.add(all.back());
  }
  std::sort(all.begin(), all.end());
  for (double q : {0.01, 0.5, 0.9, 0.99, 0.999}) {
    const auto exact = all[static_cast<std::size_t>(q * static_cast<double>(all.size()))];
    EXPECT_NEAR(static_cast<double>(stats.quantile(q)), static_cast<double>(exact), 25.0) << q;
  }
  EXPECT_EQ(stats.longest_us(), all.back());
  EXPECT_EQ(stats.count(), all.size());
}

TEST(PeriodStats, LongStallsAndEmptyHistograms) {
  PeriodStats stats;
  EXPECT_EQ(stats.quantile(0.5), 0);
  stats.add(5'000'000);
  EXPECT_EQ(stats.quantile(0.5), 5'000'000);
  stats.add(-3);
  EXPECT_EQ(stats.count(), 2u);
  EXPECT_LE(stats.quantile(0.5), 20);
}

}  // namespace period_stats_test
}  // namespace filum
