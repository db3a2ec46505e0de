#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "training/retraction_task.h"

namespace filum {
namespace retraction_goal_test {

RetractionGoal goal(const std::string& fields) { return parse_goal(YamlNode::parse("{ " + fields + " }", "task.yaml")); }

/// Field that the error names; empty if there is none.
std::string refused(const std::string& fields) {
  try {
    goal(fields);
  } catch (const InputError& e) {
    return e.field;
  }
  return "";
}

TEST(RetractionGoal, PressesWithinABandOfPressure) {
  const RetractionGoal g = goal("kind: press, for: 3 s, from: 10 mmHg, to: 20 mmHg, blind: true");
  EXPECT_EQ(g.kind, RetractionGoal::Kind::press);
  EXPECT_NEAR(g.low / kMmHg, 10.0, 1e-9);
  EXPECT_NEAR(g.high / kMmHg, 20.0, 1e-9);
  EXPECT_EQ(g.seconds, 3.0);
  EXPECT_TRUE(g.blind);
  EXPECT_EQ(refused("kind: press, for: 3 s, from: 10 mmHg, to: 10 mmHg"), "to") << "a band without width";
  EXPECT_EQ(refused("kind: press, for: 3 s, from: -1 mmHg, to: 10 mmHg"), "from");
}

TEST(RetractionGoal, ReleasesBelowAPressureThatCanBeReached) {
  const RetractionGoal g = goal("kind: release, for: 2 s, below: 5 mmHg");
  EXPECT_EQ(g.kind, RetractionGoal::Kind::release);
  EXPECT_NEAR(g.high / kMmHg, 5.0, 1e-9);
  EXPECT_EQ(g.low, 0.0);
  EXPECT_FALSE(g.blind);
  EXPECT_EQ(refused("kind: release, for: 2 s, below: 0 mmHg"), "below");
}

/// Unless told otherwise any pressure will do, in the hand or on the arm.
TEST(RetractionGoal, ExposesAShareOfTheTarget) {
  const RetractionGoal g = goal("kind: expose, for: 10 s, share: 0.8");
  EXPECT_EQ(g.kind, RetractionGoal::Kind::expose);
  EXPECT_EQ(g.share, 0.8);
  EXPECT_TRUE(std::isinf(g.high));
  EXPECT_FALSE(g.on_arm);
  EXPECT_TRUE(goal("kind: expose, for: 10 s, share: 0.8, on_arm: true").on_arm);
  EXPECT_NEAR(goal("kind: expose, for: 10 s, share: 0.8, below: 20 mmHg").high / kMmHg, 20.0, 1e-9);
  EXPECT_EQ(refused("kind: expose, for: 10 s"), "share");
  EXPECT_EQ(refused("kind: expose, for: 10 s, share: 1.1"), "share");
}

TEST(RetractionGoal, HoldsByShareOrByPressure) {
  const RetractionGoal by_pressure = goal("kind: hold, for: 60 s, from: 4 mmHg");
  EXPECT_EQ(by_pressure.kind, RetractionGoal::Kind::hold);
  EXPECT_NEAR(by_pressure.low / kMmHg, 4.0, 1e-9);
  EXPECT_EQ(by_pressure.share, 0.0);
  EXPECT_EQ(goal("kind: hold, for: 60 s, share: 0.5").low, 0.0);
  EXPECT_EQ(refused("kind: hold, for: 60 s"), "share") << "holds nothing";
}

TEST(RetractionGoal, TakesNoLongerThanTwoHours) {
  EXPECT_EQ(goal("kind: release, for: 120 min, below: 5 mmHg").seconds, 7200.0);
  EXPECT_EQ(refused("kind: release, for: 121 min, below: 5 mmHg"), "for");
  EXPECT_EQ(refused("kind: release, below: 5 mmHg"), "for");
}

}  // namespace retraction_goal_test
}  // namespace filum
