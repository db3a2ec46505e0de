#include "devices/pose_script.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <sstream>

#include "base/error.h"

namespace filum {
namespace pose_script_test {

const char* kGood = R"(
format: filum-demonstration/1
title: A wrap
tools:
  - tool: 0
    keys:
      - { t: "0 s", p: ["-4 mm", "0 mm", "6 mm"], handle: [-0.5, 0, 0.85], opening: [0, 1, 0.2], grip: "12 deg", say: "Look" }
      - { t: "1 s", p: ["2 mm", "0 mm", "0 mm"], buttons: [cut, next], stop: true }
      - { t: "2 s", arc: { centre: ["0 mm", "0 mm", "0 mm"], axis: [0, 2, 0], turns: -1.25, rise: "1 mm" }, say: "Wrap" }
      - { t: "2500 ms", grip: "0 deg" }
  - tool: 2
    keys:
      - { t: "1 s", p: ["0 mm", "0 mm", "1 cm"], handle: [0, 0, 1], opening: [1, 0, 0], grip: "0.1 rad", grip_force: "200 mN" }
)";

TEST(PoseScript, ReadsWhatTheFormatPromises) {
  const PoseScript script = PoseScript::parse(kGood, "wrap.yaml");
  EXPECT_EQ(script.title(), "A wrap");
  EXPECT_EQ(script.n_tools(), 3);
  EXPECT_TRUE(script.has_tool(0));
  EXPECT_FALSE(script.has_tool(1));
  EXPECT_DOUBLE_EQ(script.duration(), 2.5);
  const DeviceSample start = script.at(0, 0.0);
  EXPECT_TRUE(start.has_pose && start.has_grip_angle);
  EXPECT_FALSE(start.has_grip_force);
  EXPECT_NEAR((start.X_WD.p - Vec3(-4e-3, 0, 6e-3)).norm(), 0.0, 1e-15);
  EXPECT_NEAR(start.grip_angle, 12 * std::numbers::pi / 180, 1e-12);
  EXPECT_EQ(script.at(0, 1.5).buttons, 6u);
  EXPECT_TRUE(script.at(2, 5.0).has_grip_force);
  EXPECT_NEAR(script.at(2, 5.0).grip_force, 0.2, 1e-15);
  EXPECT_FALSE(script.at(1, 1.0).has_pose);
  EXPECT_FALSE(script.at(7, 1.0).has_pose);
}

TEST(PoseScript, HandleIsZAndOpeningIsMadePerpendicular) {
  const DeviceSample s = PoseScript::parse(kGood, "wrap.yaml").at(0, 0.0);
  const Vec3 z = Vec3(-0.5, 0, 0.85).normalized(), opening(0, 1, 0.2);
  EXPECT_NEAR((s.X_WD.q * Vec3::UnitZ() - z).norm(), 0.0, 1e-14);
  EXPECT_NEAR((s.X_WD.q * Vec3::UnitX()).dot(z), 0.0, 1e-14);
  EXPECT_NEAR((s.X_WD.q * Vec3::UnitX() - (opening - opening.dot(z) * z).normalized()).norm(), 0.0, 1e-14);
}

TEST(PoseScript, ArcWithoutPGoesWhereItsTurnsLead) {
  const PoseScript script = PoseScript::parse(kGood, "wrap.yaml");
  // 1.25 turns the negative way about y from +x end at +z.
  EXPECT_NEAR((script.at(0, 2.0).X_WD.p - Vec3(0, 1e-3, 2e-3)).norm(), 0.0, 1e-15);
  EXPECT_NEAR((script.at(0, 2.5).X_WD.p - Vec3(0, 1e-3, 2e-3)).norm(), 0.0, 1e-15) << "kept by the next key";
  EXPECT_NEAR(script.at(0, 1.5).X_WD.p.y(), 0.5e-3, 1e-15);
}

TEST(PoseScript, SaysWhatIsBeingShown) {
  const PoseScript script = PoseScript::parse(kGood, "wrap.yaml");
  EXPECT_EQ(script.say(0, 0.5), "Look");
  EXPECT_EQ(script.say(0, 1.5), "Look");
  EXPECT_EQ(script.say(0, 9.0), "Wrap");
  EXPECT_EQ(script.say(2, 0.5), "");
  EXPECT_EQ(script.say(1, 0.5), "");
}

struct Bad {
  const char* name;
  std::string field;  // must be in the message
  std::string from, to;
};

TEST(PoseScript, RefusesBadFilesByName) {
  const Bad cases[] = {
      {"format", "format", "filum-demonstration/1", "filum-demonstration/9"},
      {"no title", "title", "title: A wrap", ""},
      {"unit", "p", "\"-4 mm\"", "\"-4 kg\""},
      {"bare number", "p", "\"-4 mm\"", "-4"},
      {"NaN", "p", "\"-4 mm\"", "\"nan mm\""},
      {"far away", "p", "\"-4 mm\"", "\"-4 m\""},
      {"time runs back", "t", "t: \"2 s\"", "t: \"0.5 s\""},
      {"same time", "t", "t: \"2 s\"", "t: \"1 s\""},
      {"button", "buttons", "[cut, next]", "[cut, fly]"},
      {"unknown key", "speed", "stop: true", "speed: 3"},
      {"zero handle", "handle", "[-0.5, 0, 0.85]", "[0, 0, 0]"},
      {"parallel opening", "opening", "[0, 1, 0.2]", "[-0.5, 0, 0.85]"},
      {"zero axis", "axis", "[0, 2, 0]", "[0, 0, 0]"},
      {"axis through tip", "centre", "centre: [\"0 mm\", \"0 mm\", \"0 mm\"]",
       "centre: [\"2 mm\", \"0 mm\", \"0 mm\"]"},
      {"arc on first key", "arc", "grip: \"0.1 rad\"", "grip: \"0.1 rad\", arc: {}"},
      {"turns not at p", "turns",
       "stop: true }\n      - { t: \"2 s\", arc: { centre: [\"0 mm\", \"0 mm\", \"0 mm\"], axis: [0, 2, 0], "
       "turns: -1.25, rise: \"1 mm\" }",
       "stop: true }\n      - { t: \"2 s\", p: [\"2 mm\", \"0 mm\", \"0 mm\"], arc: { centre: [\"0 mm\", \"0 "
       "mm\", \"0 mm\"], axis: [0, 2, 0], turns: -1.25 }"},
      {"tool index", "tool", "tool: 2", "tool: 3"},
      {"tool twice", "tool", "tool: 2", "tool: 0"},
      {"grip", "grip", "\"12 deg\"", "\"120 deg\""},
      {"unknown object", "at.cup", "grip: \"0 deg\"", "at: { cup: 1 }"},
      {"two objects", "at.exit", "grip: \"0 deg\"", "at: { entry: 1, exit: 1 }"},
      {"thread from nowhere", "at.from", "grip: \"0 deg\"", "at: { thread: \"1 mm\" }"},
      {"way number", "at.exit", "grip: \"0 deg\"", "at: { exit: 0 }"},
      {"knot from nowhere", "at.from", "grip: \"0 deg\"", "at: { knot: \"1 mm\" }"},
      {"a third stump", "at.edge", "grip: \"0 deg\"", "at: { edge: 2 }"},
      {"axes", "at.axes", "grip: \"0 deg\"", "at: { exit: 1, axes: needle }"},
      {"at without p", "p", "grip: \"0 deg\"", "at: { exit: 1 }, handle: [0, 0, 1], opening: [1, 0, 0]"},
      {"at without handle", "handle", "grip: \"0 deg\"", "at: { exit: 1 }, p: [\"0 mm\", \"0 mm\", \"0 mm\"], opening: [1, 0, 0]"},
      {"follow nothing", "at.follow", "grip: \"0 deg\"", "at: { follow: true }, p: [\"0 mm\", \"0 mm\", \"0 mm\"], handle: [0, 0, 1], opening: [1, 0, 0]"},
      {"follow oneself", "at.tool", "grip: \"0 deg\"", "at: { tool: 0, follow: true }"},
      {"pull in mm", "until.pull", "grip: \"0 deg\"", "until: { pull: \"3 mm\" }"},
      {"no pull", "until.pull", "grip: \"0 deg\"", "until: { pull: \"0 N\" }"},
      {"until on the first key", "until", "grip: \"0.1 rad\"", "grip: \"0.1 rad\", until: { pull: \"1 mN\" }"},
      {"at on the first key", "at", "grip: \"0.1 rad\"", "grip: \"0.1 rad\", at: { exit: 1 }"},
      {"needle brought to its own tool", "at.tool", "grip: \"0 deg\"", "at: { tool: 0, bring: \"1 mm\" }"},
      {"no keys", "keys", "tool: 2\n    keys:", "tool: 2\n    keys: []\n    x:"},
  };
  for (const Bad& bad : cases) {
    std::string text = kGood;
    const auto at = text.find(bad.from);
    ASSERT_NE(at, std::string::npos) << bad.name;
    text.replace(at, bad.from.size(), bad.to);
    try {
      PoseScript::parse(text, "bad.yaml");
      ADD_FAILURE() << bad.name << " was accepted";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("bad.yaml"), std::string::npos) << error.what();
      EXPECT_NE(error.field.find(bad.field), std::string::npos) << bad.name << ": " << error.what();
      EXPECT_FALSE(error.expected.empty());
    }
  }
}

TEST(PoseScript, TruncationNeverCrashesAndIsNeverTakenForTheWhole) {
  const std::string text = kGood;
  const double whole = PoseScript::parse(text, "t.yaml").at(2, 1.0).grip_force;
  for (std::size_t n = 0; n + 3 < text.size(); ++n) {
    try {
      const PoseScript script = PoseScript::parse(text.substr(0, n), "t.yaml");
      EXPECT_FALSE(script.has_tool(2) && script.at(2, 1.0).grip_force == whole) << "cut at " << n;
    } catch (const InputError&) {
    }
  }
}

TEST(PoseScript, MissingFileIsNamed) {
  try {
    PoseScript::load("no/such/demonstration.yaml");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("no/such/demonstration.yaml"), std::string::npos);
  }
}

}  // namespace pose_script_test
}  // namespace filum
