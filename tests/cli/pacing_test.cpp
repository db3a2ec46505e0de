#include "cli/pacing.h"

#include <gtest/gtest.h>

namespace filum {
namespace pacing_test {

TEST(Pacing, KeepsTheGridWhenInTime) {
  Pacing pacing(2e-3);
  EXPECT_EQ(pacing.due(1000), 1000);
  EXPECT_EQ(pacing.due(1500), 3000);
  EXPECT_EQ(pacing.due(3070), 5000);
}

TEST(Pacing, LateStepsAreNotCaughtUp) {
  Pacing pacing(2e-3);
  pacing.due(0);
  EXPECT_EQ(pacing.due(50'000), 50'000);
  EXPECT_EQ(pacing.due(50'100), 52'000);
}

TEST(Pacing, CountsOverrunsAndTellsTheSlowdown) {
  Pacing pacing(2e-3);
  EXPECT_FALSE(pacing.ended(0, 2000));
  for (int i = 1; i < 5000; ++i) EXPECT_TRUE(pacing.ended(4000 * i, 4000 * i + 2001));
  EXPECT_EQ(pacing.overruns(), 4999u);
  EXPECT_NEAR(pacing.real_time_factor(), 0.5, 1e-3);
}

}  // namespace pacing_test
}  // namespace filum
