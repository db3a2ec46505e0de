#include "world/brain_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "base/tet_mesh.h"
#include "tests/refusal.h"

namespace filum {
namespace brain_file_test {

namespace fs = std::filesystem;

constexpr const char* kBlade = R"(format: filum-spatula/1
title: Made up
width: "1.5 cm"
tip_width: "12 mm"
taper: "20 mm"
length: "80 mm"
grip: "0.1 m"
bends:
  - { at: "30 mm", angle: "60 deg", over: "15 mm" }
  - { at: "50 mm", angle: "-0.5 rad", over: "10 mm" }
source: test
)";

/// A small flat block: coarse, without furrows that would move its surface.
constexpr const char* kBrain = R"(format: filum-brain/1
title: Made up
shape:
  size: ["40 mm", "30 mm", "20 mm"]
  cells: { along: 4, across: 4, deep: 3 }
  gyrus: "12 mm"
  sulcus: "0 mm"
  grey: "4 mm"
grey:
  young: { value: "3 kPa", uncertainty: "1 kPa", source: test }
  poisson: { value: "0.45", uncertainty: "0.04", source: test }
  density: { value: "1.04 g/cm3", uncertainty: "10 kg/m3", source: test }
white:
  young: { value: "4000 Pa", uncertainty: "2 kPa", source: test }
  poisson: { value: "0.4", uncertainty: "0.04", source: test }
  density: { value: "1040 kg/m3", uncertainty: "10 kg/m3", source: test }
stiffness_dial: "2"
mass_damping: { value: "20 1/s", uncertainty: "20 1/s", source: test }
stiffness_damping: { value: "10 ms", uncertainty: "10 ms", source: test }
relaxing_share: { value: "0.75", uncertainty: "0.15", source: test }
relaxation_time: { value: "6 min", uncertainty: "120 s", source: test }
friction: { value: "0.2", uncertainty: "0.1", source: test }
reach: "6.5 mm"
)";

constexpr const char* kScene = R"(format: filum-brain-scene/1
title: Made up
brain: block
step: "5 ms"
time_compression: "10"
section: "-3 mm"
target: { p: ["1 mm", "-2 mm", "-20 mm"], radius: "3 mm" }
blades:
  - { model: wide, name: left, p: ["0 mm", "-12 mm", "8 mm"], handle: [0, 0, 2], opening: [1, 0, 0] }
)";

constexpr const char* kSecond = "  - { model: wide, p: [\"0 mm\", \"12 mm\", \"8 mm\"], handle: [0, 0, 1], opening: [1, 0, 0] }\n";
constexpr const char* kVein =
    "veins:\n  - { cortex: [\"0.4 mm\", \"-0.3 mm\", \"2 mm\"], dura: [\"0 mm\", \"3 mm\", \"4 mm\"], slack: \"1.5\", "
    "stiffness: \"8 N/m\", strength: \"150 mN\", source: test }\n";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

/// A root with one scene, one brain and two blades.
class BrainFile : public testing::Test {
 protected:
  BrainFile() : root_(fs::temp_directory_path() / ("filum_brain_file_" + std::to_string(::getpid()))) {
    for (const char* folder : {"curricula/made-up", "models/brain", "models/spatula"}) fs::create_directories(root_ / folder);
    write("models/spatula/wide.yaml", kBlade);
    write("models/spatula/narrow.yaml", replaced(replaced(kBlade, "1.5 cm", "6 mm"), "12 mm", "4 mm"));
  }
  ~BrainFile() override { fs::remove_all(root_); }

  std::string write(const std::string& file, const std::string& text) const {
    std::ofstream(root_ / file) << text;
    return (root_ / file).string();
  }
  std::shared_ptr<const Model> load(const std::string& scene = kScene, const std::string& brain = kBrain, const std::string& model_file = "") const {
    write("curricula/made-up/scene.yaml", scene);
    write("models/brain/block.yaml", brain);
    return load_brain_scene(root_.string(), "made-up", model_file);
  }
  InputError refusal(const std::string& scene, const std::string& brain = kBrain) const { return refusal_by([&] { load(scene, brain); }); }
  static void expect_names(const InputError& error, const std::string& file, const std::string& field, const std::string& value, const std::string& expected) {
    EXPECT_NE(error.file.find(file), std::string::npos) << error.what();
    EXPECT_EQ(error.field, field) << error.what();
    EXPECT_NE(error.value.find(value), std::string::npos) << error.what();
    EXPECT_NE(error.expected.find(expected), std::string::npos) << error.what();
  }
  void expect_scene_refused(const std::string& scene, const std::string& field, const std::string& value, const std::string& expected) const {
    expect_names(refusal(scene), "curricula/made-up/scene.yaml", field, value, expected);
  }
  void expect_brain_refused(const std::string& brain, const std::string& field, const std::string& value, const std::string& expected) const {
    expect_names(refusal(kScene, brain), "models/brain/block.yaml", field, value, expected);
  }
  InputError blade_refusal(const std::string& text) const { return refusal_by([&] { load_blade(write("models/spatula/bad.yaml", text)); }); }

  fs::path root_;
};

// --- models/spatula -----------------------------------------------------------------------------------------------------

TEST_F(BrainFile, ABladeIsReadInMetresAndRadians) {
  const BladeShape b = load_blade((root_ / "models/spatula/wide.yaml").string());
  EXPECT_EQ(b.name, "Made up");
  EXPECT_NEAR(b.width, 15e-3, 1e-15);
  EXPECT_NEAR(b.tip_width, 12e-3, 1e-15);
  EXPECT_NEAR(b.taper, 20e-3, 1e-15);
  EXPECT_NEAR(b.length, 80e-3, 1e-15);
  EXPECT_NEAR(b.grip, 0.1, 1e-15);
  ASSERT_EQ(b.bends.size(), 2u);
  EXPECT_NEAR(b.bends[0].at, 30e-3, 1e-15);
  EXPECT_NEAR(b.bends[0].angle, std::numbers::pi / 3.0, 1e-12);
  EXPECT_NEAR(b.bends[0].length, 15e-3, 1e-15);
  EXPECT_NEAR(b.bends[1].angle, -0.5, 1e-15);
}

TEST_F(BrainFile, ABladeOfTwoToTwentyFiveMillimetresIsTaken) {
  for (const char* width : {"2 mm", "25 mm"}) EXPECT_EQ(blade_refusal(replaced(kBlade, "1.5 cm", width)).value, "taken") << width;
  for (const char* width : {"1.9 mm", "25.1 mm"}) {
    const InputError error = blade_refusal(replaced(kBlade, "12 mm", width));
    expect_names(error, "models/spatula/bad.yaml", "tip_width", std::string(width).substr(0, 3), "2 mm to 25 mm");
  }
}

TEST_F(BrainFile, ABladeIsRefusedByFieldAndValue) {
  const auto refused = [&](const std::string& from, const std::string& to, const std::string& field, const std::string& value) {
    expect_names(blade_refusal(replaced(kBlade, from, to)), "models/spatula/bad.yaml", field, value, "");
  };
  for (const char* key : {"title", "width", "tip_width", "taper", "length", "grip", "source"})
    refused("\n" + std::string(key) + ":", "\nnot_" + std::string(key) + ":", key, "nothing");
  refused("filum-spatula/1", "filum-spatula/2", "format", "filum-spatula/2");
  refused("taper: \"20 mm\"", "taper: \"81 mm\"", "taper", "81");
  refused("length: \"80 mm\"", "length: \"80 kPa\"", "length", "80 kPa");
  refused("at: \"30 mm\"", "at: \"81 mm\"", "bends", "81");
  refused("60 deg", "190 deg", "bends[0].angle", "190 deg");
  refused("over: \"15 mm\"", "over: \"0 mm\"", "bends[0].over", "0 mm");
  refused("source: test", "source: test\nthickness: \"1 mm\"", "thickness", "1 mm");
}

// --- models/brain -------------------------------------------------------------------------------------------------------

TEST_F(BrainFile, TissueIsReadInSiUnitsAndTheDialTurnsBothModuli) {
  const auto b = load()->brain;
  EXPECT_EQ(b->name, "Made up");
  ASSERT_EQ(b->regions.size(), 2u);
  EXPECT_NEAR(b->regions[0].young, 6000.0, 1e-9) << "grey first; twice 3 kPa";
  EXPECT_NEAR(b->regions[1].young, 8000.0, 1e-9);
  EXPECT_NEAR(b->regions[0].poisson, 0.45, 1e-15);
  EXPECT_NEAR(b->regions[1].poisson, 0.4, 1e-15);
  EXPECT_NEAR(b->regions[0].density, 1040.0, 1e-9);
  EXPECT_NEAR(b->fem.mass_damping, 20.0, 1e-12);
  EXPECT_NEAR(b->fem.stiffness_damping, 0.01, 1e-15);
  EXPECT_NEAR(b->contact.friction, 0.2, 1e-15);
  EXPECT_NEAR(b->contact.reach, 6.5e-3, 1e-15);
  EXPECT_FALSE(b->fem.averaged_pressure);
  EXPECT_FALSE(b->falx.present());
  EXPECT_TRUE(b->veins.empty());
}

TEST_F(BrainFile, WithoutADialTheModuliAreTheFilesAndItTurnsTenfoldAtMost) {
  EXPECT_NEAR(load(kScene, replaced(kBrain, "stiffness_dial: \"2\"\n", ""))->brain->regions[0].young, 3000.0, 1e-9);
  EXPECT_NEAR(load(kScene, replaced(kBrain, "stiffness_dial: \"2\"", "stiffness_dial: \"0.1\""))->brain->regions[0].young, 300.0, 1e-9);
  expect_brain_refused(replaced(kBrain, "stiffness_dial: \"2\"", "stiffness_dial: \"10.1\""), "stiffness_dial", "10.1", "10");
  expect_brain_refused(replaced(kBrain, "stiffness_dial: \"2\"", "stiffness_dial: \"2 mm\""), "stiffness_dial", "2 mm", "");
}

TEST_F(BrainFile, RelaxationIsATermUnlessNothingRelaxesOrTheSceneHasNone) {
  const auto relaxation = load()->brain->fem.relaxation;
  ASSERT_EQ(relaxation.size(), 1u);
  EXPECT_NEAR(relaxation[0].share, 0.75, 1e-15);
  EXPECT_NEAR(relaxation[0].time, 360.0, 1e-9);
  EXPECT_TRUE(load(kScene, replaced(kBrain, "value: \"0.75\"", "value: \"0\""))->brain->fem.relaxation.empty());
  EXPECT_TRUE(load(kScene + std::string("relaxation: false\n"))->brain->fem.relaxation.empty());
  EXPECT_EQ(load(kScene + std::string("relaxation: true\n"))->brain->fem.relaxation.size(), 1u);
  expect_brain_refused(replaced(kBrain, "value: \"0.75\"", "value: \"1\""), "relaxing_share.value", "1", "0.99");
}

TEST_F(BrainFile, TheBlockLiesBelowItsTopAboutTheMiddle) {
  const Points x = load()->brain->cortex.mesh.nodes;
  EXPECT_NEAR(x.row(0).maxCoeff(), 20e-3, 1e-12);
  EXPECT_NEAR(x.row(0).minCoeff(), -20e-3, 1e-12);
  EXPECT_NEAR(x.row(1).maxCoeff(), 15e-3, 1e-12);
  EXPECT_NEAR(x.row(2).maxCoeff(), 0.0, 1e-12);
  EXPECT_NEAR(x.row(2).minCoeff(), -20e-3, 1e-12);
}

/// It is tied to the free node that is nearest to where the file says, and slack by its own length from there.
TEST_F(BrainFile, AVeinGoesFromTheNearestFreeNodeToTheDura) {
  const auto b = load(kScene, std::string(kBrain) + kVein)->brain;
  ASSERT_EQ(b->veins.size(), 1u);
  const BridgingVein& v = b->veins[0];
  const Vec3 at = b->cortex.mesh.nodes.col(v.node);
  EXPECT_LT(at.norm(), 1e-12) << "the node in the middle of the top";
  EXPECT_LT((v.dura_W - Vec3(0, 3e-3, 4e-3)).norm(), 1e-15);
  EXPECT_NEAR(v.slack, 1.5 * 5e-3, 1e-15) << "1.5 times the 5 mm between them";
  EXPECT_NEAR(v.stiffness, 8.0, 1e-12);
  EXPECT_NEAR(v.strength, 0.15, 1e-15);
}

TEST_F(BrainFile, AVeinAtTheHeldBorderIsTiedToAFreeNode) {
  const auto b = load(kScene, std::string(kBrain) + replaced(kVein, "\"0.4 mm\", \"-0.3 mm\", \"2 mm\"", "\"20 mm\", \"0 mm\", \"0 mm\""))->brain;
  ASSERT_EQ(b->veins.size(), 1u);
  EXPECT_FALSE(std::binary_search(b->cortex.held.begin(), b->cortex.held.end(), b->veins[0].node));
  EXPECT_LT((Vec3(b->cortex.mesh.nodes.col(b->veins[0].node)) - Vec3(10e-3, 0, 0)).norm(), 1e-12);
}

TEST_F(BrainFile, VeinsAreRefusedByFieldAndValue) {
  const std::string vein = kVein, second = vein.substr(vein.find('\n') + 1), good = kBrain + vein;
  expect_brain_refused(good + second, "veins[1].cortex", "", "a place of its own");
  expect_brain_refused(replaced(good, "slack: \"1.5\"", "slack: \"0.99\""), "veins[0].slack", "0.99", "1");
  expect_brain_refused(replaced(good, "slack: \"1.5\"", "slack: \"3.01\""), "veins[0].slack", "3.01", "3");
  expect_brain_refused(replaced(good, "stiffness: \"8 N/m\"", "stiffness: \"0 N/m\""), "veins[0].stiffness", "0 N/m", "N/m");
  expect_brain_refused(replaced(good, "\"150 mN\"", "\"150 mm\""), "veins[0].strength", "150 mm", "N");
  expect_brain_refused(replaced(good, "\"0.4 mm\"", "\"1001 mm\""), "veins[0].cortex", "", "within 1000 mm");
}

TEST_F(BrainFile, AFalxStandsFromItsBottomToItsTop) {
  const std::string falx = "falx: { y: \"-1 mm\", bottom: \"-12 mm\", top: \"3 mm\", source: test }\n", good = kBrain + falx;
  const FalxSheet f = load(kScene, good)->brain->falx;
  EXPECT_TRUE(f.present());
  EXPECT_NEAR(f.y, -1e-3, 1e-15);
  EXPECT_NEAR(f.bottom, -12e-3, 1e-15);
  EXPECT_NEAR(f.top, 3e-3, 1e-15);
  expect_brain_refused(replaced(good, "top: \"3 mm\"", "top: \"-12 mm\""), "falx.top", "-12 mm", "a height above the bottom");
  expect_brain_refused(kBrain + replaced(falx, ", source: test", ""), "falx.source", "nothing", "text");
}

TEST_F(BrainFile, TissueIsRefusedByFieldAndValue) {
  for (const char* key : {"title", "shape", "grey", "white", "mass_damping", "stiffness_damping", "relaxing_share", "relaxation_time", "friction", "reach"})
    expect_brain_refused(replaced(kBrain, "\n" + std::string(key) + ":", "\nnot_" + std::string(key) + ":"), key, "nothing", "");
  expect_brain_refused(replaced(kBrain, "\"0.45\"", "\"0.5\""), "grey.poisson.value", "0.5", "0.4999");
  expect_brain_refused(replaced(kBrain, "\"4000 Pa\"", "\"4000\""), "white.young.value", "4000", "kPa");
  expect_brain_refused(replaced(kBrain, "\"1.04 g/cm3\"", "\"1.04 kg/m3\""), "grey.density.value", "1.04 kg/m3", "kg/m3");
  expect_brain_refused(replaced(kBrain, "\"10 ms\", uncertainty", "\"11 s\", uncertainty"), "stiffness_damping.value", "11 s", "ms");
  expect_brain_refused(replaced(kBrain, "reach: \"6.5 mm\"", "reach: \"6.5 m\""), "reach", "6.5 m", "mm");
  expect_brain_refused(replaced(kBrain, "across: 4", "across: 5"), "cells", "5", "an even number across");
  expect_brain_refused(replaced(kBrain, "deep: 3", "deep: 1"), "shape.cells.deep", "1", "a whole number from 2 to 100");
  expect_brain_refused(replaced(kBrain, "sulcus: \"0 mm\"", "sulcus: \"4 mm\""), "sulcus", "0.004", "less than a fifth of the depth");
  expect_brain_refused(std::string(kBrain) + "colour: pink\n", "colour", "pink", "");
  expect_brain_refused(replaced(kBrain, "filum-brain/1", "filum-brain/2"), "format", "filum-brain/2", "filum-brain/1");
}

/// Its file lies beside the brain's; what is below a height is held.
TEST_F(BrainFile, AMeshOfItsOwnIsHeldBelowAHeight) {
  const std::string text = kBrain, shape = text.substr(text.find("shape:"), text.find("grey:\n") - text.find("shape:"));
  const auto with = [&](const std::string& lines) { return replaced(kBrain, shape, lines); };
  save_mesh(box_mesh(Vec3(-0.02, -0.02, -0.02), Vec3(0.02, 0.02, 0.0), 4, 4, 4), (root_ / "models/brain/box.msh").string());
  const auto b = load(kScene, with("mesh: box.msh\nheld_below: \"-12 mm\"\n"))->brain;
  EXPECT_EQ(b->mesh_name, "box.msh");
  EXPECT_EQ(b->mesh_file, (root_ / "models/brain/box.msh").string());
  EXPECT_EQ(b->cortex.mesh.n_nodes(), 125);
  EXPECT_EQ(b->cortex.held.size(), 50u) << "two of five layers";
  const auto ringed = load(kScene, with("mesh: box.msh\nheld_below: \"-12 mm\"\nheld_beyond: \"21 mm\"\n"))->brain;
  EXPECT_EQ(ringed->cortex.held.size(), 50u + 3u * 12u) << "and of the other three what is further than 21 mm from the middle: corners and their neighbours";
  for (const char* name : {"../box.msh", "/tmp/box.msh", "a/b->msh", "..msh"})
    expect_brain_refused(with("mesh: " + std::string(name) + "\nheld_below: \"-12 mm\"\n"), "mesh", name, "a file beside this one");
  expect_brain_refused(with("mesh: box.msh\n"), "held_below", "nothing", "mm");
}

// --- scenes -------------------------------------------------------------------------------------------------------------

TEST_F(BrainFile, ASceneIsReadWithAllItIsMadeFrom) {
  const auto m = load();
  const BrainModel& b = *m->brain;
  EXPECT_EQ(m->sources, (std::vector<std::string>{"curricula/made-up/scene.yaml", "models/brain/block.yaml", "models/spatula/wide.yaml"}));
  EXPECT_EQ(m->description.task, "made-up");
  EXPECT_EQ(m->description.suture, "none");
  EXPECT_NEAR(m->description.dt, 5e-3, 1e-15);
  EXPECT_EQ(m->step.dt, m->description.dt);
  EXPECT_EQ(b.fem.dt, m->description.dt);
  EXPECT_NEAR(b.section_x, -3e-3, 1e-15);
  EXPECT_EQ(b.time_compression, 10.0);
  EXPECT_LT((b.target_W - Vec3(1e-3, -2e-3, -20e-3)).norm(), 1e-15);
  EXPECT_NEAR(b.target_radius, 3e-3, 1e-15);
}

TEST_F(BrainFile, WhatASceneLeavesOutIsAsStated) {
  std::string bare = replaced(kScene, "time_compression: \"10\"\nsection: \"-3 mm\"\ntarget: { p: [\"1 mm\", \"-2 mm\", \"-20 mm\"], radius: \"3 mm\" }\n", "");
  bare = replaced(bare, "name: left, ", "");
  const auto b = load(bare)->brain;
  EXPECT_EQ(b->section_x, 0.0);
  EXPECT_EQ(b->time_compression, 1.0);
  EXPECT_EQ(b->target_radius, 0.0) << "no target";
  EXPECT_EQ(b->blade_names, std::vector<std::string>{"Made up"}) << "the blade's title";
  EXPECT_EQ(b->arm_keeps_force.at(0), 0);
  EXPECT_TRUE(b->placed.at(0).empty());
}

/// Frame T: z along the blade towards the handle, x the way the opening shows; lengths of the directions do not count.
TEST_F(BrainFile, ABladeStartsWhereItsFrameIsPut) {
  const auto m = load();
  const Pose& X = m->brain->blade_start.at(0);
  EXPECT_LT((X.p - Vec3(0, -12e-3, 8e-3)).norm(), 1e-15);
  EXPECT_LT((X.q * Vec3::UnitZ() - Vec3::UnitZ()).norm(), 1e-12);
  EXPECT_LT((X.q * Vec3::UnitX() - Vec3::UnitX()).norm(), 1e-12);
  EXPECT_EQ(m->description.n_tools, 1);
  const ToolShape& tool = m->description.tools[0];
  EXPECT_EQ(tool.name, "left");
  EXPECT_EQ(tool.kind, "spatula");
  EXPECT_NEAR(tool.jaw_length, 80e-3, 1e-15);
  EXPECT_NEAR(tool.tip_radius, 6e-3, 1e-15) << "half its width at the tip";
  EXPECT_NEAR(tool.base_radius, 7.5e-3, 1e-15);
}

TEST_F(BrainFile, ABladeHasItsFormsAndEachFileIsNamedOnce) {
  const std::string both = replaced(kScene, "model: wide, ", "model: wide, others: [narrow, wide], ") +
                           replaced(kSecond, "model: wide, ", "model: narrow, others: [wide, narrow], ");
  const auto m = load(both);
  ASSERT_EQ(m->brain->blades.size(), 2u);
  EXPECT_EQ(m->description.n_tools, 2);
  ASSERT_EQ(m->brain->blades[0].size(), 3u);
  EXPECT_NEAR(m->brain->blades[0][0].width, 15e-3, 1e-15) << "the first to start with";
  EXPECT_NEAR(m->brain->blades[0][1].width, 6e-3, 1e-15);
  EXPECT_NEAR(m->brain->blades[1][0].width, 6e-3, 1e-15);
  EXPECT_EQ(std::count(m->sources.begin(), m->sources.end(), "models/spatula/wide.yaml"), 1);
  EXPECT_EQ(std::count(m->sources.begin(), m->sources.end(), "models/spatula/narrow.yaml"), 1);
  expect_scene_refused(replaced(kScene, "model: wide, ", "model: wide, others: [narrow], ") + kSecond, "blades[1].others", "nothing", "as many as the first blade has");
}

TEST_F(BrainFile, ABladesFileIsNamedByTheFieldThatNamesIt) {
  expect_scene_refused(replaced(kScene, "model: wide", "model: ../spatula/wide"), "blades[0].model", "../spatula/wide", "models/spatula");
  expect_scene_refused(replaced(kScene, "model: wide, ", "model: wide, others: [narrow, a/b], "), "blades[0].others", "", "models/spatula");
  EXPECT_NE(refusal(replaced(kScene, "model: wide", "model: none")).file.find("models/spatula/none.yaml"), std::string::npos);
}

TEST_F(BrainFile, OneOrTwoBladesAreTaken) {
  const std::string scene = kScene, none = scene.substr(0, scene.find("blades:"));
  expect_scene_refused(none, "blades", "nothing", "");
  expect_scene_refused(none + "blades: []\n", "blades", "", "one or two blades");
  expect_scene_refused(scene + kSecond + kSecond, "blades[2].model", "wide", "at most two blades");
}

TEST_F(BrainFile, AnArmKeepsThePoseUnlessItIsToldToKeepTheForce) {
  EXPECT_EQ(load(replaced(kScene, "model: wide, ", "model: wide, arm: force, "))->brain->arm_keeps_force.at(0), 1);
  EXPECT_EQ(load(replaced(kScene, "model: wide, ", "model: wide, arm: pose, "))->brain->arm_keeps_force.at(0), 0);
  expect_scene_refused(replaced(kScene, "model: wide, ", "model: wide, arm: torque, "), "blades[0].arm", "torque", "one of pose force");
}

TEST_F(BrainFile, ABladeThatSomebodyPlacedGoesFromItsStart) {
  const auto with = [](const std::string& first, const std::string& second) {
    const std::string key = ", p: [\"0 mm\", \"-12 mm\", \"2 mm\"], handle: [0, 0, 1], opening: [1, 0, 0] }";
    return replaced(kScene, "model: wide, ", "model: wide, placed: [{ t: \"" + first + "\"" + key + ", { t: \"" + second + "\"" + key + "], ");
  };
  const auto keys = load(with("500 ms", "2 s"))->brain->placed.at(0);
  ASSERT_EQ(keys.size(), 3u);
  EXPECT_EQ(keys[0].t, 0.0);
  EXPECT_LT((keys[0].X_W.p - Vec3(0, -12e-3, 8e-3)).norm(), 1e-15);
  EXPECT_NEAR(keys[1].t, 0.5, 1e-15);
  EXPECT_NEAR(keys[2].t, 2.0, 1e-15);
  EXPECT_LT((keys[2].X_W.p - Vec3(0, -12e-3, 2e-3)).norm(), 1e-15);
  expect_scene_refused(with("2 s", "2 s"), "blades[0].placed[1].t", "2 s", "");
  expect_scene_refused(with("0 s", "2 s"), "blades[0].placed[0].t", "0 s", "");
  expect_scene_refused(with("1 s", "601 s"), "blades[0].placed[1].t", "601 s", "600 s");
}

TEST_F(BrainFile, AScenesNumbersAreRefusedByFieldAndValue) {
  EXPECT_NEAR(load(replaced(kScene, "step: \"5 ms\"", "step: \"20 ms\""))->step.dt, 0.02, 1e-15);
  EXPECT_NEAR(load(replaced(kScene, "step: \"5 ms\"", "step: \"0.5 ms\""))->step.dt, 5e-4, 1e-15);
  expect_scene_refused(replaced(kScene, "step: \"5 ms\"", "step: \"21 ms\""), "step", "21 ms", "ms");
  expect_scene_refused(replaced(kScene, "step: \"5 ms\"", "step: \"0.4 ms\""), "step", "0.4 ms", "ms");
  expect_scene_refused(replaced(kScene, "time_compression: \"10\"", "time_compression: \"0.9\""), "time_compression", "0.9", "60");
  expect_scene_refused(replaced(kScene, "time_compression: \"10\"", "time_compression: \"61\""), "time_compression", "61", "60");
  expect_scene_refused(replaced(kScene, "radius: \"3 mm\"", "radius: \"0 mm\""), "target.radius", "0 mm", "mm");
  expect_scene_refused(replaced(kScene, "section: \"-3 mm\"", "section: \"-3 s\""), "section", "-3 s", "mm");
  expect_scene_refused(replaced(kScene, "opening: [1, 0, 0]", "opening: [0, 0, 1]"), "blades[0].opening", "", "not along the handle");
  expect_scene_refused(std::string(kScene) + "residual: \"0.02\"\n", "residual", "0.02", "");
  expect_scene_refused(std::string(kScene) + "iterations: \"0\"\n", "iterations", "0", "a whole number from 1 to 10000");
  expect_scene_refused(std::string(kScene) + "floor: \"-3 mm\"\n", "floor", "-3 mm", "");
  expect_scene_refused(replaced(kScene, "filum-brain-scene/1", "filum-scene/1"), "format", "filum-scene/1", "filum-brain-scene/1");
  EXPECT_NE(refusal(replaced(kScene, "brain: block", "brain: none")).file.find("models/brain/none.yaml"), std::string::npos);
}

TEST_F(BrainFile, AnotherBrainTakesThePlaceOfTheScenes) {
  const std::string other = write("models/brain/other.yaml", replaced(kBrain, "title: Made up", "title: Another"));
  const auto m = load(kScene, kBrain, other);
  EXPECT_EQ(m->brain->name, "Another");
  EXPECT_EQ(std::count(m->sources.begin(), m->sources.end(), other), 1);
  EXPECT_EQ(std::count(m->sources.begin(), m->sources.end(), "models/brain/block.yaml"), 0);
}

TEST_F(BrainFile, ATaskThatIsNotThereIsRefused) { EXPECT_THROW(load_brain_scene(root_.string(), "nowhere", ""), InputError); }

}  // namespace brain_file_test
}  // namespace filum
