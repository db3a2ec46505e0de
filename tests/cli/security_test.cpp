#include "cli/security.h"

#include <gtest/gtest.h>

#include "cli/setup.h"

// A knot that is pulled to the end: knot_demo_test.sh; the pull test itself: world/pull_test_test.
namespace filum {
namespace security_test {

TEST(Security, WhatIsNotFinishedOrHasNoKnotIsNotPulled) {
  for (const char* name : {"knot-square", "tip-hold"}) {
    const auto setup = load_setup(FILUM_SOURCE_DIR, name);
    World world(setup.model);
    TaskSession task(setup.task, world.description());
    world.step(Inputs());
    task.observe(world.observation());
    const Result result = finish_with_security(task, world, [](double) {
      ADD_FAILURE() << "pulled";
      return false;
    });
    EXPECT_FALSE(result.finished);
    EXPECT_FALSE(result.security.has_value());
    EXPECT_EQ(result.has_knot, std::string(name) == "knot-square");
    EXPECT_FALSE(has_knot_to_pull(task, world, result));
  }
}

TEST(Security, AFinishedKnotOnAPostIsPulledAnUnknotIsNot) {
  const auto setup = load_setup(FILUM_SOURCE_DIR, "knot-square");
  World world(setup.model);
  TaskSession task(setup.task, world.description());
  Result result;
  result.finished = true;
  result.knot.knot_class = "granny";
  EXPECT_TRUE(has_knot_to_pull(task, world, result));
  result.knot.knot_class = "unknot";
  EXPECT_FALSE(has_knot_to_pull(task, world, result));
}

}  // namespace security_test
}  // namespace filum
