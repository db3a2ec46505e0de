#include "base/ensure.h"

#include <gtest/gtest.h>

TEST(Ensure, PassesAndEvaluatesOnce) {
  int calls = 0;
  ENSURE(++calls == 1, "first call");
  EXPECT_EQ(calls, 1);
}

TEST(EnsureDeathTest, StopsWithPlaceConditionAndReason) {
  const int nodes = 3;
  EXPECT_DEATH(ENSURE(nodes > 4, "a rod needs five nodes"),
               "ensure_test.cpp.*nodes > 4.*a rod needs five nodes");
}

TEST(EnsureDeathTest, AssertStopsInDebugOnly) {
  bool reached = false;
#ifdef NDEBUG
  ASSERT(false, "not looked at");
  reached = true;
  EXPECT_TRUE(reached);
#else
  EXPECT_DEATH(ASSERT(reached, "looked at"), "looked at");
#endif
}
