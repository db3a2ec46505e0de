#include <gtest/gtest.h>

#include <string>

#include "base/error.h"
#include "training/needle_task.h"

namespace filum {
namespace needle_goal_test {

NeedleGoal goal(const std::string& text) { return parse_needle_goal(YamlNode::parse(text, "t.yaml")); }

/// The message of what is refused; empty: nothing is.
std::string refused(const std::string& text) {
  try {
    goal(text);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(NeedleGoal, EachKindReadsWhatItNeedsInSi) {
  const NeedleGoal load = goal("{ kind: load, tool: 1, from: 0.5, to: 0.75, square_within: \"15 deg\", for: \"0.5 s\" }");
  EXPECT_EQ(load.kind, NeedleGoal::Kind::load);
  EXPECT_EQ(load.tool, 1);
  EXPECT_EQ(load.low, 0.5);
  EXPECT_EQ(load.high, 0.75);
  EXPECT_NEAR(load.angle, 0.2618, 1e-4);
  EXPECT_EQ(load.seconds, 0.5);
  const NeedleGoal grasp = goal("{ kind: grasp, tool: 0, side: 1, pull_from: \"0.3 mN\", pull_to: \"2 mN\", for: \"1 s\" }");
  EXPECT_EQ(grasp.kind, NeedleGoal::Kind::grasp);
  EXPECT_EQ(grasp.side, 1);
  EXPECT_NEAR(grasp.low, 0.3e-3, 1e-12);
  EXPECT_NEAR(grasp.high, 2e-3, 1e-12);
  const NeedleGoal tie = goal("{ kind: tie, passes: 2, throws: 2, knot: [square, surgeons], loop: \"6 mm\", for: \"0.5 s\" }");
  EXPECT_EQ(tie.knots, (std::vector<std::string>{"square", "surgeons"}));
  EXPECT_NEAR(tie.loop, 6e-3, 1e-12);
  const NeedleGoal draw = goal("{ kind: draw, passes: 2, tail: \"16 mm\" }");
  EXPECT_NEAR(draw.tail, 16e-3, 1e-12);
  EXPECT_EQ(goal("{ kind: pass, passes: 3 }").passes, 3);
  EXPECT_EQ(goal("{ kind: cut }").passes, 2);
}

TEST(NeedleGoal, WhatIsWrongIsRefusedByFieldAndExpectation) {
  EXPECT_NE(refused("{ kind: grasp, side: 2, pull_from: \"0.3 mN\", pull_to: \"2 mN\", for: \"1 s\" }").find("side"), std::string::npos);
  EXPECT_NE(refused("{ kind: grasp, side: 0, pull_from: \"3 mN\", pull_to: \"2 mN\", for: \"1 s\" }").find("pull_to"), std::string::npos) << "less than from";
  EXPECT_NE(refused("{ kind: grasp, side: 0, pull_from: \"0.3 mm\", pull_to: \"2 mN\", for: \"1 s\" }").find("pull_from"), std::string::npos) << "a length";
  EXPECT_NE(refused("{ kind: load, from: 0.8, to: 0.5, square_within: \"15 deg\", for: \"1 s\" }").find("to"), std::string::npos);
  EXPECT_NE(refused("{ kind: tie, passes: 2, throws: 2, knot: [bow], loop: \"6 mm\", for: \"1 s\" }").find("knot"), std::string::npos);
  const std::string kind = refused("{ kind: pinch }");
  EXPECT_NE(kind.find("kind"), std::string::npos);
  EXPECT_NE(kind.find("grasp"), std::string::npos) << "says what there is";
  EXPECT_NE(refused("{ kind: pass, passes: 0 }").find("passes"), std::string::npos);
}

}  // namespace needle_goal_test
}  // namespace filum
