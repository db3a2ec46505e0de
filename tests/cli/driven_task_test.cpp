#include "cli/driven_task.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "devices/pose_script.h"
#include "tests/refusal.h"
#include "tests/session/synthetic.h"
#include "world/model.h"

namespace filum {
namespace driven_task_test {

namespace fs = std::filesystem;

/// Held still with the hand free, but within a tenth of a second: straight from one place to another, then the wrist turns.
constexpr const char* kScript = R"(format: filum-demonstration/1
title: A short way
tools:
  - tool: 0
    keys:
      - { t: 0 s, p: [-6 mm, -3 mm, 8 mm], handle: [-0.4, -0.5, 0.76], opening: [1, 0, 0], grip: 3 deg }
      - { t: 0.06 s, p: [0 mm, 0 mm, 5 mm], stop: true }
      - { t: 0.1 s, p: [0 mm, 0 mm, 5 mm], grip: 6 deg, stop: true }
)";

/// A root with the shipped models and two tasks: one with that demonstration, one with none.
class DrivenTaskTest : public testing::Test {
 protected:
  DrivenTaskTest() {
    const fs::path source = FILUM_SOURCE_DIR;
    fs::create_directory_symlink(source / "models", folder_.file("models"));
    for (const char* task : {"short-hold", "no-hands"}) {
      fs::create_directories(folder_.file(std::string("curricula/") + task));
      for (const char* file : {"scene.yaml", "task.yaml"}) fs::copy(source / "curricula/research/tip-hold" / file, folder_.file(std::string("curricula/") + task + "/" + file));
    }
    std::ofstream(folder_.file("curricula/short-hold/demonstration.yaml")) << kScript;
  }
  DrivenTask task(const std::string& name = "short-hold") const { return driven_task(folder_.file(""), name); }
  InputError refusal(const std::string& root, const std::string& name) const { return refusal_by([&] { driven_task(root, name); }); }
  synthetic::Folder folder_;
};

/// The hands are asked in the middle of the coming step, a sample each millisecond.
DeviceSample scripted(double scene_time, double dt) {
  static const PoseScript script = PoseScript::parse(kScript, "short");
  return script.at(0, 1e-3 * std::floor(1e3 * (scene_time + 0.5 * dt) + 1e-6));
}

TEST_F(DrivenTaskTest, ItsHandsFollowTheScenesClock) {
  const DrivenTask driven = task();
  World world(driven.model);
  ASSERT_EQ(world.description().dt, 2e-3);
  for (int k = 0; k < 60; ++k) {
    const Inputs inputs = driven.inputs(world);
    const DeviceSample expected = scripted(world.observation().time, world.description().dt);
    ASSERT_TRUE(inputs.tools[0].valid) << k;
    EXPECT_LT((inputs.tools[0].X_WD.p - expected.X_WD.p).norm(), 1e-12) << k;
    EXPECT_LT(inputs.tools[0].X_WD.q.angularDistance(expected.X_WD.q), 1e-7) << k;
    EXPECT_NEAR(inputs.tools[0].grip_angle, expected.grip_angle, 1e-12) << k;
    EXPECT_FALSE(inputs.tools[1].valid) << "no hand moves it";
    world.step(inputs);
  }
}

TEST_F(DrivenTaskTest, AskedAgainInTheSameStepTheySayTheSame) {
  const DrivenTask driven = task();
  World world(driven.model);
  for (int k = 0; k < 10; ++k) world.step(driven.inputs(world));
  const Inputs first = driven.inputs(world), again = driven.inputs(world);
  EXPECT_EQ(first.tools[0].X_WD.p, again.tools[0].X_WD.p);
  EXPECT_EQ(first.tools[0].grip_angle, again.tools[0].grip_angle);
}

TEST_F(DrivenTaskTest, ItIsOverWhenTheLastKeyIsPassedAndNotBefore) {
  const DrivenTask driven = task();
  World world(driven.model);
  EXPECT_FALSE(driven.over());
  while (world.observation().time < 0.097) {
    world.step(driven.inputs(world));
    ASSERT_FALSE(driven.over()) << world.observation().time;
  }
  for (int k = 0; k < 5; ++k) world.step(driven.inputs(world));
  EXPECT_TRUE(driven.over());
}

TEST_F(DrivenTaskTest, EachHasHandsOfItsOwn) {
  const DrivenTask one = task(), other = task();
  World world(one.model), late(other.model);
  for (int k = 0; k < 60; ++k) world.step(one.inputs(world));
  EXPECT_TRUE(one.over());
  EXPECT_FALSE(other.over());
  for (int k = 0; k < 60; ++k) late.step(other.inputs(late));
  EXPECT_EQ(world.state_hash(), late.state_hash()) << "same hands, same states";
}

TEST_F(DrivenTaskTest, ATaskWithoutADemonstrationIsNamedWithTheFileThatIsMissing) {
  const InputError error = refusal(folder_.file(""), "no-hands");
  EXPECT_EQ(error.file, "--input");
  EXPECT_EQ(error.field, "demo");
  EXPECT_EQ(error.value, "no-hands");
  EXPECT_NE(error.expected.find("curricula/no-hands/demonstration.yaml is not there"), std::string::npos) << error.what();
}

TEST_F(DrivenTaskTest, AnUnknownTaskIsAnsweredWithThoseThereAre) {
  const InputError error = refusal(folder_.file(""), "short-hole");
  EXPECT_EQ(error.field, "task") << error.what();
  EXPECT_EQ(error.value, "short-hole");
  EXPECT_EQ(error.expected, "one of: no-hands, short-hold");
}

TEST_F(DrivenTaskTest, ARootWithoutTasksIsNamed) {
  const InputError error = refusal(folder_.file("nowhere"), "short-hold");
  EXPECT_EQ(error.file, "--root") << error.what();
  EXPECT_EQ(error.value, folder_.file("nowhere"));
}

TEST_F(DrivenTaskTest, ADemonstrationThatCannotBeReadIsNamedByItsFile) {
  std::ofstream(folder_.file("curricula/short-hold/demonstration.yaml")) << "format: filum-demonstration/9\n";
  const InputError error = refusal(folder_.file(""), "short-hold");
  EXPECT_NE(error.file.find("curricula/short-hold/demonstration.yaml"), std::string::npos) << error.what();
  EXPECT_EQ(error.field, "format");
  EXPECT_EQ(error.value, "\"filum-demonstration/9\"");
}

}  // namespace driven_task_test
}  // namespace filum
