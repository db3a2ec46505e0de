#include "world/vessel_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <set>

#include "tests/refusal.h"
#include "world/wall_file.h"

namespace filum {
namespace vessel_file_test {

namespace fs = std::filesystem;

const std::string kRoot = FILUM_SOURCE_DIR;

/// Two layers; other units than those of the shipped files.
constexpr const char* kTrack = R"(format: filum-track/1
title: Made up
layers:
  - puncture: { value: "2500 uN", uncertainty: "1 mN", source: test }
    cutting: { value: "1 mN", uncertainty: "1 mN", source: test }
    friction: { value: "8 mN/mm", uncertainty: "6 N/m", source: test }
    drag: { value: "20 N.s/m2", uncertainty: "20 N.s/m2", source: test }
  - puncture: { value: "4 mN", uncertainty: "1 mN", source: test }
    cutting: { value: "0 mN", uncertainty: "1 mN", source: test }
    friction: { value: "0 N/m", uncertainty: "1 N/m", source: test }
    drag: { value: "0 N.s/m2", uncertainty: "1 N.s/m2", source: test }
hold: { value: "400 N/m", uncertainty: "200 N/m", source: test }
stiffens: { value: "0.1 mm", uncertainty: "10 um", source: test }
point_stiffness: { value: "1.5 kN/m", uncertainty: "1000 N/m", source: test }
least_angle: { value: "15 deg", uncertainty: "5 deg", source: test }
thread_share: { value: "0.4", uncertainty: "0.2", source: test }
bend_friction: { value: "0.25", uncertainty: "0.1", source: test }
tear: { value: "500 N/m", uncertainty: "250 N/m", source: test }
exit_share: { value: "0.3", uncertainty: "0.2", source: test }
wear: { value: "0.02 1/N", uncertainty: "0.02 1/N", source: test }
spacing: "0.05 mm"
)";

constexpr const char* kCard = R"(kind: card
name: made-up
track: latex
layers:
  - { name: latex, thickness: "150 um", young: "1200 kPa", poisson: "0.45", source: test }
width: "4 mm"
depth: "3 mm"
across: "8"
deep: "6"
gap: "0.2 mm"
centre: ["1 mm", "-2 mm", "3 mm"]
damping: "100 1/s"
)";

constexpr const char* kStumps = R"(kind: vessel
preset: silicone-tube
track: silicone
stump: "2.4 mm"
around: "12"
along: "4"
grading: "2"
gap: "0.6 mm"
turn: "0 deg"
centre: ["1 mm", "-2 mm", "3 mm"]
)";

constexpr const char* kBlood = "blood: { pressure: \"75 mmHg\", back: \"25 mmHg\", opening: \"5 mmHg\" }\n";
constexpr const char* kSide = "side: { lean: \"40 deg\", length: \"4.4 mm\", along: \"24\", opening: \"1.35 mm\", width: \"0.55 mm\", half_across: \"3\", "
                              "opening_along: \"8\", over: \"-90 deg\" }\n";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

Model model_of(const std::string& text, const std::string& vessel_file = "") {
  Model m;
  m.step.dt = 2e-3;
  const YamlNode node = YamlNode::parse(text, "scene.yaml");
  read_tissue(kRoot, node, vessel_file, m);
  node.finish();
  return m;
}

InputError refusal_of(const std::string& text) { return refusal_by([&] { model_of(text); }); }

/// Refused by the file, the field's path and what was found.
void expect_refused(const std::string& text, const std::string& field, const std::string& value, const std::string& expected) {
  const InputError error = refusal_of(text);
  EXPECT_EQ(error.file.find("scene.yaml:"), 0u) << error.what();
  EXPECT_EQ(error.field, field) << error.what();
  EXPECT_NE(error.value.find(value), std::string::npos) << error.what();
  EXPECT_NE(error.expected.find(expected), std::string::npos) << error.what();
}

/// Nodes that belong to one part, relative to a place.
Points nodes_of(const VesselMesh& mesh, int part, const Vec3& from) {
  Points all(3, std::count(mesh.node_part.begin(), mesh.node_part.end(), part));
  for (Eigen::Index i = 0, n = 0; i < mesh.nodes.cols(); ++i)
    if (mesh.node_part[static_cast<std::size_t>(i)] == part) all.col(n++) = mesh.nodes.col(i) - from;
  return all;
}

const Vec3 kCentre(1e-3, -2e-3, 3e-3);  // [m], of the scenes above

// --- models/track ------------------------------------------------------------------------------------------------------

class TrackFile : public testing::Test {
 protected:
  TrackFile() : path_((fs::temp_directory_path() / ("filum_track_" + std::to_string(::getpid()) + ".yaml")).string()) {}
  ~TrackFile() override { fs::remove(path_); }
  TrackMaterial load(const std::string& text) const {
    std::ofstream(path_) << text;
    return load_track(path_);
  }
  InputError refusal(const std::string& text) const { return refusal_by([&] { load(text); }); }
  std::string path_;
};

TEST_F(TrackFile, EveryNumberIsReadInSiUnits) {
  const TrackMaterial m = load(kTrack);
  ASSERT_EQ(m.layers.size(), 2u);
  EXPECT_NEAR(m.layers[0].puncture, 2.5e-3, 1e-15);
  EXPECT_NEAR(m.layers[0].cutting, 1e-3, 1e-15);
  EXPECT_NEAR(m.layers[0].friction, 8.0, 1e-12);
  EXPECT_NEAR(m.layers[0].drag, 20.0, 1e-12);
  EXPECT_NEAR(m.layers[1].puncture, 4e-3, 1e-15) << "inner first, as they stand";
  EXPECT_EQ(m.layers[1].drag, 0.0);
  EXPECT_NEAR(m.hold, 400.0, 1e-10);
  EXPECT_NEAR(m.stiffens, 1e-4, 1e-16);
  EXPECT_NEAR(m.point_stiffness, 1500.0, 1e-10);
  EXPECT_NEAR(m.least_angle, std::numbers::pi / 12.0, 1e-12);
  EXPECT_NEAR(m.thread_share, 0.4, 1e-15);
  EXPECT_NEAR(m.bend_friction, 0.25, 1e-15);
  EXPECT_NEAR(m.tear, 500.0, 1e-10);
  EXPECT_NEAR(m.exit_share, 0.3, 1e-15);
  EXPECT_NEAR(m.wear, 0.02, 1e-15);
  EXPECT_NEAR(m.spacing, 50e-6, 1e-16);
}

TEST_F(TrackFile, TissueNeedNotStiffen) {
  EXPECT_EQ(load(replaced(kTrack, "stiffens: { value: \"0.1 mm\", uncertainty: \"10 um\", source: test }\n", "")).stiffens, 0.0);
}

TEST_F(TrackFile, EveryOtherFieldIsRequiredByItsName) {
  for (const char* key : {"title", "layers", "hold", "point_stiffness", "least_angle", "thread_share", "bend_friction", "tear", "exit_share", "wear", "spacing"}) {
    const InputError error = refusal(replaced(kTrack, "\n" + std::string(key) + ":", "\nnot_" + std::string(key) + ":"));
    EXPECT_EQ(error.field, key) << error.what();
    EXPECT_EQ(error.value, "nothing") << key;
    EXPECT_EQ(error.file.find(path_), 0u) << error.what();
  }
  for (const char* key : {"cutting", "friction", "drag"}) EXPECT_EQ(refusal(replaced(kTrack, "    " + std::string(key) + ":", "    x:")).field, "layers[0]." + std::string(key));
}

TEST_F(TrackFile, BoundsAreTakenAndWhatLiesBeyondIsRefused) {
  const auto with = [](const std::string& key, const std::string& old, const std::string& value) {
    return replaced(kTrack, key + ": { value: \"" + old + "\"", key + ": { value: \"" + value + "\"");
  };
  EXPECT_EQ(load(with("exit_share", "0.3", "1")).exit_share, 1.0);
  EXPECT_EQ(load(with("exit_share", "0.3", "0")).exit_share, 0.0);
  EXPECT_NEAR(load(with("least_angle", "15 deg", "90 deg")).least_angle, 0.5 * std::numbers::pi, 1e-12);
  const auto refused = [&](const std::string& key, const std::string& old, const std::string& value) {
    const InputError error = refusal(with(key, old, value));
    EXPECT_EQ(error.field, key + ".value") << error.what();
    EXPECT_NE(error.value.find(value), std::string::npos) << error.what();
  };
  refused("exit_share", "0.3", "1.001");
  refused("least_angle", "15 deg", "90.1 deg");
  refused("least_angle", "15 deg", "-1 deg");
  refused("bend_friction", "0.25", "2.01");
  refused("thread_share", "0.4", "-0.1");
  refused("wear", "0.02 1/N", "-1 1/N");
  refused("hold", "400 N/m", "0 N/m");
  refused("tear", "500 N/m", "400 N");
  refused("stiffens", "0.1 mm", "0.1 um");
}

TEST_F(TrackFile, ANumberWithoutASourceIsRefused) {
  const InputError error = refusal(replaced(kTrack, "uncertainty: \"250 N/m\", source: test }", "uncertainty: \"250 N/m\" }"));
  EXPECT_EQ(error.field, "tear.source") << error.what();
  EXPECT_EQ(refusal(replaced(kTrack, "{ value: \"500 N/m\", uncertainty: \"250 N/m\", source: test }", "\"500 N/m\"")).field, "tear");
}

TEST_F(TrackFile, WhatIsNoTrackIsRefused) {
  EXPECT_EQ(refusal(replaced(kTrack, "filum-track/1", "filum-track/2")).field, "format");
  EXPECT_EQ(refusal(std::string(kTrack) + "colour: red\n").field, "colour");
  const std::string text = kTrack;
  const auto from = text.find("layers:"), to = text.find("hold:");
  const InputError none = refusal(text.substr(0, from) + "layers: []\n" + text.substr(to));
  EXPECT_EQ(none.field, "layers") << none.what();
  EXPECT_EQ(none.expected, "at least one layer");
  EXPECT_THROW(load_track(path_ + ".none"), InputError);
}

// --- which files are vessels --------------------------------------------------------------------------------------------

TEST(VesselFile, PresetsAreToldByTheirFormat) {
  EXPECT_TRUE(is_vessel(kRoot + "/models/vessel/silicone-tube.yaml"));
  EXPECT_TRUE(is_vessel(kRoot + "/models/vessel/latex-card.yaml"));
  EXPECT_FALSE(is_vessel(kRoot + "/models/suture/10-0-nylon.yaml"));
  EXPECT_FALSE(is_vessel(""));
  EXPECT_THROW(is_vessel(kRoot + "/models/vessel/none.yaml"), InputError);
}

// --- cards --------------------------------------------------------------------------------------------------------------

TEST(VesselFile, ACardIsTwoFlapsAcrossACutAlongX) {
  const Model m = model_of(kCard);
  const VesselModel& v = *m.vessel;
  EXPECT_EQ(v.kind, "card");
  EXPECT_EQ(v.name, "made-up");
  EXPECT_FALSE(v.lumen);
  EXPECT_EQ(v.cut_along, Vec3(Vec3::UnitX()));
  EXPECT_NEAR(v.thickness, 150e-6, 1e-15);
  EXPECT_NEAR(v.wall.damping, 100.0, 1e-12);
  EXPECT_EQ(v.wall.dt, 2e-3);
  EXPECT_EQ(m.sources, std::vector<std::string>{"models/track/latex.yaml"});
  for (const int part : {0, 1}) {
    const Points x = nodes_of(v.mesh, part, kCentre);
    const double side = part == 0 ? -1.0 : 1.0;
    EXPECT_NEAR((side * x.row(1)).minCoeff(), 0.1e-3, 1e-12) << "half the gap";
    EXPECT_NEAR((side * x.row(1)).maxCoeff(), 3.1e-3, 1e-12);
    EXPECT_NEAR(x.row(0).minCoeff(), -2e-3, 1e-12);
    EXPECT_NEAR(x.row(0).maxCoeff(), 2e-3, 1e-12);
    EXPECT_NEAR(x.row(2).maxCoeff(), 75e-6, 1e-12);
    EXPECT_NEAR(x.row(2).minCoeff(), -75e-6, 1e-12);
  }
}

TEST(VesselFile, LayersAddUpAndHaveTheirModuli) {
  const std::string more = "layers:\n  - { name: felt, thickness: \"0.05 mm\", young: \"0.1 MPa\", poisson: \"0\", source: test }\n";
  const InputError error = refusal_of(replaced(kCard, "layers:\n", more));
  EXPECT_EQ(error.field, "track");
  EXPECT_NE(error.expected.find("made-up has 2, this track 1"), std::string::npos) << error.what();
  const std::string alone = "{ name: felt, thickness: \"0.05 mm\", young: \"0.1 MPa\", poisson: \"0.25\", source: test }";
  const VesselModel v = *model_of(replaced(kCard, "{ name: latex, thickness: \"150 um\", young: \"1200 kPa\", poisson: \"0.45\", source: test }", alone)).vessel;
  EXPECT_NEAR(v.thickness, 50e-6, 1e-15);
  EXPECT_NEAR(v.layers.at(0).law.mu, 40e3, 1e-6) << "E / (2 (1 + nu))";
  EXPECT_NEAR(v.layers.at(0).law.lambda, 40e3, 1e-6) << "E nu / ((1 + nu) (1 - 2 nu))";
}

/// The frame's sides are no edges: thread that runs over them meets nothing.
TEST(VesselFile, AnUncutCardIsHeldAllRoundInItsFrame) {
  const VesselMesh mesh = model_of(replaced(kCard, "gap: \"0.2 mm\"", "uncut: true")).vessel->mesh;
  const Points x = nodes_of(mesh, 0, kCentre);
  ASSERT_EQ(x.cols(), mesh.nodes.cols()) << "one part";
  EXPECT_NEAR(x.row(1).minCoeff(), -1.5e-3, 1e-12);
  EXPECT_NEAR(x.row(1).maxCoeff(), 1.5e-3, 1e-12);
  std::set<int> border;
  for (int i = 0; i < x.cols(); ++i)
    if (std::abs(x(0, i)) > 2e-3 - 1e-9 || std::abs(x(1, i)) > 1.5e-3 - 1e-9) border.insert(i);
  EXPECT_EQ(std::set<int>(mesh.held.begin(), mesh.held.end()), border);
  for (const WallFace& f : mesh.faces) EXPECT_TRUE(f.surface == WallSurface::inner || f.surface == WallSurface::outer);
}

/// Stretched by s along x and y without a force across: 1/s each way and, by plane stress, thicker by 2 nu/(1 - nu) (s - 1).
TEST(VesselFile, AStretchedCardWouldBeSmallerAndThickerWithoutStress) {
  const std::string uncut = replaced(kCard, "gap: \"0.2 mm\"", "uncut: true");
  const VesselMesh plain = model_of(uncut).vessel->mesh, drawn = model_of(uncut + "stretch: \"1.2\"\n").vessel->mesh;
  EXPECT_EQ(plain.nodes, drawn.nodes);
  const double thicker = 1.0 + 2.0 * 0.45 / 0.55 * 0.2;
  for (std::size_t e = 0; e < plain.stress_free.size(); ++e) {
    const Corners a = plain.stress_free[e], b = drawn.stress_free[e];
    EXPECT_LT((b.topRows<2>() - a.topRows<2>() / 1.2).cwiseAbs().maxCoeff(), 1e-15);
    EXPECT_LT((b.row(2) - thicker * a.row(2)).cwiseAbs().maxCoeff(), 1e-15);
  }
  EXPECT_EQ(refusal_of(uncut + "stretch: \"1.5\"\n").value, "taken");
  expect_refused(uncut + "stretch: \"1.51\"\n", "stretch", "1.51", "1.5");
  expect_refused(uncut + "stretch: \"0.99\"\n", "stretch", "0.99", "1");
}

TEST(VesselFile, ACardIsRefusedByFieldAndValue) {
  expect_refused(replaced(kCard, "kind: card", "kind: sheet"), "kind", "sheet", "one of card vessel");
  expect_refused(replaced(kCard, "width: \"4 mm\"", "width: \"4 m\""), "width", "4 m", "mm");
  expect_refused(replaced(kCard, "width: \"4 mm\"", "width: \"4\""), "width", "4", "mm");
  expect_refused(replaced(kCard, "across: \"8\"", "across: \"1\""), "across", "1", "a whole number from 2 to 60");
  expect_refused(replaced(kCard, "deep: \"6\"", "deep: \"41\""), "deep", "41", "a whole number from 2 to 40");
  expect_refused(replaced(kCard, "gap: \"0.2 mm\"", "gap: \"-0.1 mm\""), "gap", "-0.1 mm", "mm");
  expect_refused(replaced(kCard, "poisson: \"0.45\"", "poisson: \"0.5\""), "layers[0].poisson", "0.5", "0.499");
  expect_refused(replaced(kCard, "young: \"1200 kPa\"", "young: \"0 kPa\""), "layers[0].young", "0 kPa", "kPa");
  expect_refused(replaced(kCard, ", source: test", ""), "layers[0].source", "nothing", "text");
  expect_refused(replaced(kCard, "track: latex", "tracks: latex"), "track", "nothing", "text");
  const std::string text = kCard;
  expect_refused(text.substr(0, text.find("layers:")) + "layers: []\n" + text.substr(text.find("width:")), "layers", "", "at least one layer");
  expect_refused(text + "stump: \"2 mm\"\n", "stump", "2 mm", "");
}

// --- stumps in a double clamp -------------------------------------------------------------------------------------------

TEST(VesselFile, StumpsFaceEachOtherAlongYAcrossTheGap) {
  const Model m = model_of(kStumps);
  const VesselModel& v = *m.vessel;
  EXPECT_TRUE(v.lumen);
  EXPECT_EQ(v.name, "silicone-tube");
  EXPECT_FALSE(v.adventitia);
  EXPECT_EQ(m.sources, (std::vector<std::string>{"models/vessel/silicone-tube.yaml", "models/track/silicone.yaml"}));
  EXPECT_NEAR(v.radius, 0.5e-3, 1e-12) << "0.35 mm and a wall of 0.15 mm";
  EXPECT_NEAR(v.thickness, 0.15e-3, 1e-12);
  for (const int part : {0, 1}) {
    const Points x = nodes_of(v.mesh, part, kCentre);
    const double side = part == 0 ? -1.0 : 1.0;
    EXPECT_NEAR((side * x.row(1)).minCoeff(), 0.3e-3, 1e-12) << "half the gap";
    EXPECT_NEAR((side * x.row(1)).maxCoeff(), 2.7e-3, 1e-12);
    const Eigen::VectorXd off = (x.row(0).array().square() + x.row(2).array().square()).sqrt();
    EXPECT_NEAR(off.minCoeff(), 0.35e-3, 1e-12);
    EXPECT_NEAR(off.maxCoeff(), 0.5e-3, 1e-12);
  }
  for (const int i : v.mesh.held) EXPECT_NEAR(std::abs(v.mesh.nodes(1, i) - kCentre.y()), 2.7e-3, 1e-12) << "the far ends";
}

/// Angles count from where x is least; the bar's z is along the vessel, its y up.
TEST(VesselFile, TheClampsFrameIsAlongTheVesselWithItsYUp) {
  const VesselModel v = *model_of(kStumps).vessel;
  EXPECT_LT((v.clamp.X_WB.p - kCentre).norm(), 1e-15);
  EXPECT_LT((v.clamp.X_WB.q * Vec3::UnitZ() - Vec3::UnitY()).norm(), 1e-12);
  EXPECT_LT((v.clamp.X_WB.q * Vec3::UnitY() - Vec3::UnitZ()).norm(), 1e-12);
  EXPECT_EQ(v.cut_along, Vec3(-Vec3::UnitX()));
  EXPECT_NEAR(v.clamp.gap, 0.6e-3, 1e-15);
  EXPECT_EQ(v.closed_gap, 0.0);
  EXPECT_EQ(v.slack, 0.0);
  EXPECT_EQ(v.turns, (std::vector<double>{0.0, std::numbers::pi}));
  EXPECT_FALSE(v.clamp.side);
  const VesselModel turned = *model_of(replaced(kStumps, "turn: \"0 deg\"", "turn: \"90 deg\"") + "closed_gap: \"-50 um\"\n").vessel;
  EXPECT_NEAR(turned.clamp.turn, 0.5 * std::numbers::pi, 1e-12);
  EXPECT_NEAR(turned.closed_gap, -50e-6, 1e-15);
}

TEST(VesselFile, BloodIsReadInPascalsAndWhatIsNotSaidIsAnArterys) {
  const VesselModel v = *model_of(std::string(kStumps) + kBlood).vessel;
  EXPECT_NEAR(v.circulation.pressure, 75 * 133.322, 0.1);
  EXPECT_NEAR(v.circulation.back, 25 * 133.322, 0.1);
  EXPECT_NEAR(v.circulation.opening, 5 * 133.322, 0.1);
  EXPECT_EQ(v.circulation.cut_flow, Circulation{}.cut_flow);
  EXPECT_EQ(v.circulation.through, Circulation{}.through);
  const VesselModel vein = *model_of(std::string(kStumps) + replaced(kBlood, " }", ", slack: \"-120 Pa\", cut_flow: \"60 ml/min\", through: \"6 ml/min\" }")).vessel;
  EXPECT_NEAR(vein.slack, -120.0, 1e-9);
  EXPECT_NEAR(vein.circulation.cut_flow, 1e-6, 1e-15);
  EXPECT_NEAR(vein.circulation.through, 1e-7, 1e-16);
}

/// A scene that does not say what blood its clamps keep out has the preset's: a vein that is put in an artery's place is not tested at an artery's pressure.
TEST(VesselFile, BloodIsThatOfThePresetWhereTheSceneDoesNotSay) {
  const Circulation usual, artery = model_of(kStumps).vessel->circulation;
  EXPECT_EQ(artery.pressure, usual.pressure);
  EXPECT_EQ(artery.back, usual.back);
  EXPECT_EQ(artery.opening, usual.opening);
  const std::string file = kRoot + "/models/vessel/rat-femoral-vein.yaml", scene = replaced(kStumps, "track: silicone", "track: vein");
  const Circulation vein = model_of(scene, file).vessel->circulation;
  EXPECT_NEAR(vein.pressure, load_vessel(file).pressure, 0.1);
  EXPECT_NEAR(vein.back / vein.pressure, usual.back / usual.pressure, 1e-12);
  EXPECT_NEAR(vein.opening / vein.pressure, usual.opening / usual.pressure, 1e-12);
  EXPECT_EQ(vein.through, usual.through);
  EXPECT_NEAR(model_of(scene + kBlood, file).vessel->circulation.pressure, 75 * 133.322, 0.1) << "what a scene says counts";
}

TEST(VesselFile, BloodThatDoesNotFlowDownwardsIsRefused) {
  const auto with = [](const std::string& from, const std::string& to) { return std::string(kStumps) + replaced(kBlood, from, to); };
  EXPECT_EQ(refusal_of(with("opening: \"5 mmHg\"", "opening: \"75 mmHg\"")).value, "taken");
  expect_refused(with("back: \"25 mmHg\"", "back: \"75.1 mmHg\""), "blood.back", "75.1 mmHg", "");
  expect_refused(with("opening: \"5 mmHg\"", "opening: \"76 mmHg\""), "blood.opening", "76 mmHg", "");
  expect_refused(with(" }", ", slack: \"1 mmHg\" }"), "blood.slack", "1 mmHg", "");
  expect_refused(with(" }", ", cut_flow: \"6 ml/min\", through: \"4.01 ml/min\" }"), "blood.through", "4.01 ml/min", "less than the cut vessel gives");
  EXPECT_EQ(refusal_of(with(" }", ", cut_flow: \"6 ml/min\", through: \"3.99 ml/min\" }")).value, "taken") << "two thirds of the pressure: up to two thirds of the flow";
}

TEST(VesselFile, TurnsAreTwoToSixteenAnglesFromTheFirstPlace) {
  const auto with = [](const std::string& turns) { return std::string(kStumps) + "turns: [" + turns + "]\n"; };
  std::string most = "\"0 deg\"";
  for (int k = 1; k < 16; ++k) most += ", \"" + std::to_string(20 * k) + " deg\"";
  EXPECT_EQ(model_of(with(most)).vessel->turns.size(), 16u);
  EXPECT_NEAR(model_of(with("\"0 deg\", \"-360 deg\"")).vessel->turns.at(1), -2.0 * std::numbers::pi, 1e-12);
  const char* const expected = "two to sixteen angles, the first zero";
  expect_refused(with(most + ", \"10 deg\""), "turns", "", expected);
  expect_refused(with("\"0 deg\""), "turns", "", expected);
  expect_refused(with("\"1 deg\", \"180 deg\""), "turns", "", expected);
  expect_refused(with("\"0 deg\", \"361 deg\""), "turns[1]", "361 deg", "");
}

TEST(VesselFile, AnotherPresetTakesThePlaceOfTheScenes) {
  const std::string file = kRoot + "/models/vessel/human-digital-artery.yaml";
  const Model m = model_of(replaced(kStumps, "track: silicone", "track: artery"), file);
  EXPECT_EQ(m.vessel->name, "human-digital-artery");
  EXPECT_EQ(m.sources.at(0), file);
  EXPECT_EQ(m.vessel->layers.size(), 3u);
  EXPECT_TRUE(m.vessel->adventitia);
  EXPECT_NEAR(m.vessel->thickness, load_vessel(file).shape.thickness, 1e-15);
}

TEST(VesselFile, StumpsAreRefusedByFieldAndValue) {
  const std::string card = kRoot + "/models/vessel/latex-card.yaml";
  try {
    model_of(kStumps, card);
    ADD_FAILURE() << "taken";
  } catch (const InputError& error) {
    EXPECT_EQ(error.file + ": " + error.field + ": " + error.value, card + ": kind: card") << "the file that was given, not the scene's";
  }
  expect_refused(replaced(kStumps, "preset: silicone-tube", "preset: latex-card"), "preset", "latex-card", "a vessel that is a tube");
  expect_refused(replaced(kStumps, "track: silicone", "track: artery"), "track", "artery", "silicone-tube has 1, this track 3");
  expect_refused(replaced(kStumps, "around: \"12\"", "around: \"7\""), "around", "7", "a whole number from 8 to 64");
  expect_refused(replaced(kStumps, "grading: \"2\"", "grading: \"5.1\""), "grading", "5.1", "5");
  expect_refused(replaced(kStumps, "turn: \"0 deg\"", "turn: \"181 deg\""), "turn", "181 deg", "");
  expect_refused(std::string(kStumps) + "closed_gap: \"0.61 mm\"\n", "closed_gap", "0.61 mm", "");
  expect_refused(std::string(kStumps) + "tolerance: \"101 uN\"\n", "tolerance", "101 uN", "uN");
  EXPECT_NEAR(model_of(std::string(kStumps) + "tolerance: \"100 uN\"\n").vessel->wall.tolerance, 1e-4, 1e-12);
  EXPECT_NE(refusal_of(replaced(kStumps, "preset: silicone-tube", "preset: glass")).file.find("models/vessel/glass.yaml"), std::string::npos);
  EXPECT_NE(refusal_of(replaced(kStumps, "track: silicone", "track: glass")).file.find("models/track/glass.yaml"), std::string::npos);
}

TEST(VesselFile, AnOpeningInTheSideIsRefusedByFieldAndValue) {
  const std::string good = replaced(replaced(kStumps, "around: \"12\"", "around: \"20\""), "along: \"4\"", "along: \"10\"");
  const auto with = [&](const std::string& from, const std::string& to) { return good + replaced(kSide, from, to); };
  const VesselModel v = *model_of(good + kSide).vessel;
  ASSERT_TRUE(v.clamp.side);
  EXPECT_NEAR(v.clamp.side->lean, 40.0 / 180.0 * std::numbers::pi, 1e-12);
  EXPECT_NEAR(v.clamp.side->reach, 2.2e-3, 1e-15) << "half the vessel's length";
  EXPECT_NEAR(v.clamp.side->radius, 0.5e-3, 1e-12);
  EXPECT_EQ(v.turns.size(), 2u);
  EXPECT_NEAR(v.turns.at(1), -0.5 * std::numbers::pi, 1e-12);
  EXPECT_LT((v.cut_along - Vec3::UnitY()).norm(), 1e-12) << "angles count from the heel";
  expect_refused(with("lean: \"40 deg\"", "lean: \"91 deg\""), "side.lean", "91 deg", "");
  expect_refused(with("opening: \"1.35 mm\"", "opening: \"0.24 mm\""), "side.opening", "0.24 mm", "");
  expect_refused(with("width: \"0.55 mm\"", "width: \"1.1 mm\""), "side.width", "1.1 mm", "");
  expect_refused(with("half_across: \"3\"", "half_across: \"9\""), "side.half_across", "9", "a whole number from 1 to 8");
  expect_refused(with("opening_along: \"8\"", "opening_along: \"21\""), "side.opening_along", "21", "a whole number from 2 to 20");
  expect_refused(good + "turns: [\"0 deg\", \"180 deg\"]\n" + kSide, "turns", "", "");
}

}  // namespace vessel_file_test
}  // namespace filum
