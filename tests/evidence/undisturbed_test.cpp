#include "evidence/undisturbed.h"

#include <gtest/gtest.h>

using namespace filum;

namespace undisturbed_test {

TEST(Undisturbed, TheLeastTimeOfEachStepCounts) {
  const Undisturbed u = undisturbed({{1.0, 9.0, 3.0}, {5.0, 2.0, 4.0}});
  EXPECT_EQ(u.passes, 2);
  EXPECT_EQ(u.p50_ms, 2.0);
  EXPECT_EQ(u.max_ms, 3.0);  // a step that is slow every time stays slow
}

TEST(Undisturbed, OnlyStepsOfAllPassesCount) {
  EXPECT_EQ(undisturbed({{1.0, 2.0, 30.0}, {1.0, 2.0}}).max_ms, 2.0);
  EXPECT_EQ(undisturbed({}).passes, 0);
}

}  // namespace undisturbed_test
