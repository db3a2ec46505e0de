#include "training/series_log.h"

#include <gtest/gtest.h>

#include "training/metrics.h"

namespace filum {
namespace series_log_test {

Observation seen(double time) {
  Observation o;
  o.time = time;
  for (std::size_t t = 0; t < 3; ++t) {
    o.tools[t].X_WT.p = Vec3(time, static_cast<double>(t), 2.0);
    o.tools[t].grip_force = 10.0 * static_cast<double>(t) + time;
    o.tools[t].thread_force = 20.0 * static_cast<double>(t) + time;
  }
  return o;
}

TEST(SeriesLog, KeepsEachToolsOwnSeries) {
  SeriesLog log(2, 1.0);
  EXPECT_TRUE(log.add(seen(0.5), 0.1));
  EXPECT_TRUE(log.add(seen(0.51), 0.2));
  ASSERT_EQ(log.size(), 2u);
  EXPECT_EQ(log.time(), (std::vector<double>{0.5, 0.51}));
  EXPECT_EQ(log.tension(), (std::vector<double>{0.1, 0.2}));
  const Points path = log.tool(1).path();
  ASSERT_EQ(path.cols(), 2);
  EXPECT_EQ(path.col(0), Vec3(0.5, 1.0, 2.0));
  EXPECT_EQ(path.col(1), Vec3(0.51, 1.0, 2.0));
  EXPECT_EQ(log.tool(1).grip, (std::vector<double>{10.5, 10.51}));
  EXPECT_EQ(log.tool(1).thread_force, (std::vector<double>{20.5, 20.51}));
  EXPECT_TRUE(log.tool(2).tip.empty()) << "a scene of two tools";
}

/// A run is sampled in real time: nothing is allocated as it goes on, and what goes on too long keeps what it has.
TEST(SeriesLog, FillsItsMemoryAndNoMore) {
  SeriesLog log(1, 0.055);
  EXPECT_TRUE(log.add(seen(0.0), 0.0));
  const double* time = log.time().data();
  const Vec3* tip = log.tool(0).tip.data();
  std::size_t n = 1;
  while (n < 1000 && log.add(seen(static_cast<double>(n) / kMetricRate), 0.0)) ++n;
  EXPECT_EQ(n, 7u) << "0 to 0.06 s";
  EXPECT_EQ(log.size(), n);
  EXPECT_EQ(log.tool(0).tip.size(), n) << "all series of one length";
  EXPECT_EQ(log.time().back(), 0.06);
  EXPECT_EQ(log.time().data(), time);
  EXPECT_EQ(log.tool(0).tip.data(), tip);
}

TEST(SeriesLog, HasNoMoreToolsThanAScene) {
  EXPECT_EQ(SeriesLog(5, 1.0).n_tools(), 3);
  EXPECT_EQ(SeriesLog(-1, 1.0).n_tools(), 0);
}

}  // namespace series_log_test
}  // namespace filum
