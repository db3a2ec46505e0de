#include "world/scene_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "base/error.h"
#include "world/vessel_model.h"
#include "world/wall_file.h"
#include "world/state.h"
#include "world/world.h"

namespace filum {
namespace scene_file_test {

namespace fs = std::filesystem;

/// A copy of the shipped scenes and models that a test may spoil.
class SceneFile : public testing::Test {
 protected:
  SceneFile() : root_(fs::temp_directory_path() / ("filum_scene_" + std::to_string(getpid()) + "_" +
                                                    testing::UnitTest::GetInstance()->current_test_info()->name())) {
    fs::create_directories(root_);
    for (const char* folder : {"curricula", "models"})
      fs::copy(fs::path(FILUM_SOURCE_DIR) / folder, root_ / folder, fs::copy_options::recursive);
  }
  ~SceneFile() override { fs::remove_all(root_); }

  static std::string read(const fs::path& path) {
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
  }
  static void write(const fs::path& path, const std::string& text) { std::ofstream(path) << text; }

  /// Replaces `from` in `file`, expects a refusal that names file and field, and puts the file back.
  void expect_refusal(const std::string& file, const std::string& from, const std::string& to, const std::string& field) {
    const std::string good = read(root_ / file);
    std::string bad = good;
    const auto at = bad.find(from);
    ASSERT_NE(at, std::string::npos) << from << " is not in " << file;
    bad.replace(at, from.size(), to);
    write(root_ / file, bad);
    try {
      load_model(root_.string(), "knot-square", "");
      ADD_FAILURE() << "accepted " << to << " for " << from;
    } catch (const InputError& e) {
      EXPECT_NE(e.file.find(file), std::string::npos) << e.what();
      EXPECT_NE(e.field.find(field), std::string::npos) << e.what();
      EXPECT_FALSE(e.expected.empty());
    }
    write(root_ / file, good);
  }

  fs::path root_;
  const std::string scene_ = "curricula/knot-square/scene.yaml", suture_ = "models/suture/10-0-nylon.yaml",
                    forceps_ = "models/instrument/forceps.yaml";
};

TEST_F(SceneFile, EveryShippedSceneAndSutureLoads) {
  int scenes = 0, sutures = 0;
  for (const auto& entry : fs::directory_iterator(root_ / "curricula")) {
    if (!fs::exists(entry.path() / "scene.yaml")) continue;
    EXPECT_NO_THROW(load_model(root_.string(), entry.path().filename().string(), "")) << entry.path();
    ++scenes;
  }
  for (const auto& entry : fs::directory_iterator(root_ / "models/suture")) {
    if (entry.path().filename() == "elastic.yaml" || entry.path().filename() == "capstan.yaml") continue;  // baselines of reconcile
    ContactMaterial contact;
    EXPECT_NO_THROW(load_suture(entry.path().string(), contact)) << entry.path();
    ++sutures;
  }
  EXPECT_GE(scenes, 3);
  EXPECT_GE(sutures, 6);
}

TEST_F(SceneFile, SuturesAndTurnsOfTheClamp) {
  const std::string file = "curricula/artery-knot/scene.yaml", good = read(root_ / file), turn = "  turn: \"0 deg\"\n";
  EXPECT_EQ(load_model(root_.string(), "artery-knot", "")->sutures, 1);
  const auto with = [&](const std::string& sutures, const std::string& turns) {
    std::string text = good;
    text.replace(text.find(turn), turn.size(), turn + turns);
    write(root_ / file, text + sutures);
    return load_model(root_.string(), "artery-knot", "");
  };
  const auto m = with("sutures: \"8\"\n", "  turns: [\"0 deg\", \"-180 deg\", \"90 deg\"]\n");
  EXPECT_EQ(m->sutures, 8);
  ASSERT_EQ(m->vessel->turns.size(), 3u);
  EXPECT_NEAR(m->vessel->turns[1], -3.14159265, 1e-8);
  for (const char* bad : {"  turns: [\"90 deg\", \"0 deg\"]\n", "  turns: [\"0 deg\"]\n", "  turns: [\"0 deg\", \"400 deg\"]\n"}) EXPECT_THROW(with("", bad), InputError) << bad;
  for (const char* bad : {"sutures: \"0\"\n", "sutures: \"51\"\n"}) EXPECT_THROW(with(bad, ""), InputError) << bad;
  write(root_ / file, good);
  const std::string post = read(root_ / scene_);
  write(root_ / scene_, post + "sutures: \"2\"\n");
  EXPECT_THROW(load_model(root_.string(), "knot-square", ""), InputError) << "no needle";
  write(root_ / scene_, post);
}

TEST_F(SceneFile, ReadsWhatIsWritten) {
  const auto m = load_model(root_.string(), "knot-square", "");
  EXPECT_EQ(m->description.task, "knot-square");
  EXPECT_EQ(m->description.suture, "10-0-nylon");
  EXPECT_NEAR(m->thread.radius, 12.5e-6, 1e-12);
  EXPECT_NEAR(m->thread.EI, 4.79e-11, 1e-18);
  EXPECT_NEAR(m->thread.internal_friction, 0.010, 1e-9);
  EXPECT_NEAR(m->contact.stiffness, 1.64e4, 1.0);
  EXPECT_EQ(m->description.n_tools, static_cast<int>(m->instruments.size()));
  EXPECT_GE(m->description.n_tools, 2);
  const Points& path = m->thread_path;
  double length = 0.0;
  for (int i = 0; i + 1 < path.cols(); ++i) length += (path.col(i + 1) - path.col(i)).norm();
  EXPECT_GT(length, 10e-3);
  EXPECT_LE((path.col(1) - path.col(0)).norm(), m->resolution.longest * (1 + 1e-9));
  for (const Pose& X : m->instrument_start) EXPECT_NEAR(X.q.norm(), 1.0, 1e-12);
}

TEST_F(SceneFile, AnotherSutureTakesThePlaceOfTheScenes) {
  const auto m = load_model(root_.string(), "knot-square", (root_ / "models/suture/8-0-nylon.yaml").string());
  EXPECT_EQ(m->description.suture, "8-0-nylon");
  EXPECT_GT(m->thread.radius, 15e-6);
}

TEST(SceneVessel, AnotherVesselTakesThePlaceOfTheScenes) {
  const std::string root = FILUM_SOURCE_DIR, vessels = root + "/models/vessel/";
  const auto usual = load_model(root, "artery-stitch");
  for (const char* name : {"rat-femoral-artery", "chicken-artery"}) {
    const auto model = load_model(root, "artery-stitch", vessels + name + ".yaml");
    EXPECT_EQ(model->vessel->name, name);
    EXPECT_EQ(model->description.suture, usual->description.suture);
    EXPECT_NE(model->vessel->radius, usual->vessel->radius);
    EXPECT_NEAR(model->vessel->thickness, load_vessel(vessels + name + ".yaml").shape.thickness, 1e-12);
    World world(model);
    for (int k = 0; k < 20; ++k) world.step(Inputs{});
    EXPECT_TRUE(world.state().tissue.wall.x.allFinite()) << name;
  }
  const auto refusal = [&](const std::string& task, const std::string& name) {
    try {
      load_model(root, task, vessels + name + ".yaml");
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("taken");
  };
  EXPECT_NE(refusal("artery-stitch", "silicone-tube").find("silicone-tube has 1"), std::string::npos) << "its needle track has three layers";
  EXPECT_NE(refusal("artery-stitch", "latex-card").find("latex-card.yaml: kind: found card, expected a vessel that is a tube"), std::string::npos) << refusal("artery-stitch", "latex-card");
  for (const char* task : {"knot-square", "card-stitches"}) EXPECT_NE(refusal(task, "rat-femoral-artery").find("no vessel"), std::string::npos) << task;
}

TEST_F(SceneFile, UnknownTaskIsRefused) {
  for (const char* task : {"knot-unknown", "", "../knot-square", "knot square"}) {
    try {
      load_model(root_.string(), task, "");
      ADD_FAILURE() << task;
    } catch (const InputError& e) {
      EXPECT_EQ(e.field, "task");
      EXPECT_EQ(e.value, task);
    }
  }
}

TEST_F(SceneFile, SceneErrorsNameFileAndField) {
  expect_refusal(scene_, "format: filum-scene/1", "format: filum-scene/9", "format");
  expect_refusal(scene_, "title:", "subtitle:", "title");
  expect_refusal(scene_, "step: \"2 ms\"", "step: \"2 mm\"", "step");
  expect_refusal(scene_, "step: \"2 ms\"", "step: \"2 s\"", "step");
  expect_refusal(scene_, "step: \"2 ms\"", "step: \"nan ms\"", "step");
  expect_refusal(scene_, "step: \"2 ms\"", "step: \"2 ms\"\nsurprise: 1", "surprise");
  expect_refusal(scene_, "newton_iterations:", "newton_iteration:", "newton_iteration");
  expect_refusal(scene_, "floor:", "flor:", "floor");
  expect_refusal(scene_, "post_friction: \"", "post_friction: \"-", "post_friction");
  expect_refusal(scene_, "nodes: 240", "nodes: 1", "nodes");
  expect_refusal(scene_, "axis: [0, 1, 0]", "axis: [0, 1]", "axis");
  expect_refusal(scene_, "  length: \"", "  width: \"", "length");
  expect_refusal(scene_, "  length: \"", "  length: \"9", "length");  // more nodes than there is room for
  expect_refusal(scene_, "axis: [0, 1, 0]", "axis: [0, 0, 0]", "axis");
  expect_refusal(scene_, "direction: [-1, 0, 0]", "direction: [0, 0, 0]", "direction");
  expect_refusal(scene_, "radius: \"0.4 mm\"", "radius: \"-0.4 mm\"", "radius");
}

TEST_F(SceneFile, InstrumentPoseErrorsNameFileAndField) {
  const std::string text = read(root_ / scene_);
  const auto at = text.find("handle: [");
  ASSERT_NE(at, std::string::npos);
  const std::string handle = text.substr(at, text.find(']', at) + 1 - at);
  expect_refusal(scene_, handle, "handle: [0, 0, 0]", "handle");
  const auto to = text.find("opening: [", at);
  const std::string opening = text.substr(to, text.find(']', to) + 1 - to);
  expect_refusal(scene_, opening, "opening" + handle.substr(handle.find(':')), "opening");
}

TEST_F(SceneFile, ModelErrorsNameFileAndField) {
  expect_refusal(suture_, "25 um", "25 kg", "diameter");
  expect_refusal(suture_, "25 um", "0 um", "diameter");
  expect_refusal(suture_, "source:", "origin:", "diameter");
  expect_refusal(suture_, "strength:", "strenght:", "stren");
  expect_refusal(suture_, "friction_coefficient:\n  value: \"0.2\"", "friction_coefficient:\n  value: \"-0.2\"", "friction_coefficient");
  expect_refusal(forceps_, "kind: forceps", "kind: tongs", "kind");
  expect_refusal(forceps_, "jaw_length: \"12 mm\"", "jaw_length: \"12\"", "jaw_length");
  expect_refusal(forceps_, "jaw_length: \"12 mm\"", "jaw_length: \"12 mm\"\ncolour: red", "colour");
  expect_refusal(forceps_, "max_grip_force: \"3 N\"", "max_grip_force: \"3 J\"", "max_grip_force");
}

TEST_F(SceneFile, SuturesBeyondAnyThreadAreRefused) {
  const auto value = [&](const std::string& field, const std::string& to) {
    const std::string text = read(root_ / suture_);
    const auto at = text.find("\n" + field + ":") + 1;
    const auto from = text.substr(at, text.find("uncertainty", at) - at);
    ASSERT_NE(from.find("value"), std::string::npos) << field;
    expect_refusal(suture_, from, field + ":\n  value: \"" + to + "\"\n  ", field);
  };
  for (const char* to : {"25 m", "25 nm", "1.1 mm"}) value("diameter", to);
  for (const char* to : {"1e300 N.m2", "1e-300 N.m2"}) {
    value("bending_stiffness", to);
    value("twisting_stiffness", to);
  }
  for (const char* to : {"1e300 N", "1e-300 N"}) {
    value("axial_stiffness", to);
    value("strength", to);
  }
  for (const char* to : {"1e6 kg/m3", "1e-9 kg/m3"}) value("density", to);
  for (const char* to : {"1e300 N/m", "1e-300 N/m"}) value("squeeze_stiffness", to);
  for (const char* to : {"1e-30", "1e30"}) value("yield_strain", to);
  value("air_drag", "2 N.s/m2");
  value("internal_friction", "1e5 ms");
}

TEST_F(SceneFile, InstrumentsBeyondAnyHandAreRefused) {
  for (const char* to : {"12 km", "12 nm"}) expect_refusal(forceps_, "jaw_length: \"12 mm\"", std::string("jaw_length: \"") + to + '"', "jaw_length");
  for (const char* to : {"1e-300 g", "30 kg"}) expect_refusal(forceps_, "apparent_mass: \"30 g\"", std::string("apparent_mass: \"") + to + '"', "apparent_mass");
  expect_refusal(forceps_, "tip_radius: \"0.15 mm\"", "tip_radius: \"0.15 nm\"", "tip_radius");
  expect_refusal(forceps_, "base_radius: \"0.7 mm\"", "base_radius: \"7 m\"", "base_radius");
  expect_refusal(forceps_, "shaft_length: \"60 mm\"", "shaft_length: \"60 m\"", "shaft_length");
  expect_refusal(forceps_, "\"3e-6 kg.m2\"", "\"3e6 kg.m2\"", "apparent_inertia");
  expect_refusal(forceps_, "\"500 N/m\"", "\"5e100 N/m\"", "coupling_stiffness");
  expect_refusal(forceps_, "\"0.05 N.m/rad\"", "\"1e-30 N.m/rad\"", "turning_stiffness");
  expect_refusal(forceps_, "\"0.1 N.m/rad\"", "\"1e30 N.m/rad\"", "grip_stiffness");
  expect_refusal(forceps_, "\"3 N\"", "\"3e9 N\"", "max_grip_force");
  expect_refusal(forceps_, "pad_width: \"0.3 mm\"", "pad_width: \"3 km\"", "pad_width");
  expect_refusal(forceps_, "pad_length: \"2 mm\"", "pad_length: \"2 nm\"", "pad_length");
}

TEST_F(SceneFile, GeometryBeyondTheBenchIsRefused) {
  for (const char* to : {"4 km", "0.4 nm"}) expect_refusal(scene_, "radius: \"0.4 mm\"", std::string("radius: \"") + to + '"', "radius");
  expect_refusal(scene_, "length: \"12 mm\"", "length: \"12 km\"", "length");
  expect_refusal(scene_, "\"0.410 mm\"", "\"0.410 km\"", "post.centre");
  expect_refusal(scene_, "short_end: [\"", "short_end: [\"1e9", "short_end");
  expect_refusal(scene_, "floor: \"-3 mm\"", "floor: \"-3 km\"", "floor");
  expect_refusal(scene_, "shortest: \"30 um\"", "shortest: \"30 pm\"", "shortest");
  expect_refusal(scene_, "touching: \"60 um\"", "touching: \"60 km\"", "touching");
  const std::string text = read(root_ / scene_);
  const auto at = text.find("p: [\"", text.find("instruments:"));
  ASSERT_NE(at, std::string::npos);
  const std::string place = text.substr(at, text.find(']', at) + 1 - at);
  expect_refusal(scene_, place, "p: [\"1 m\", \"1 m\", \"0 m\"]", "p");
}

TEST_F(SceneFile, TissueWithoutANeedleIsRefused) { expect_refusal(scene_, "floor: ", "tissue: { kind: card }\nfloor: ", "needle"); }

TEST_F(SceneFile, MissingModelFilesAreNamed) {
  fs::remove(root_ / forceps_);
  try {
    load_model(root_.string(), "knot-square", "");
    ADD_FAILURE();
  } catch (const InputError& e) {
    EXPECT_NE(e.file.find("forceps.yaml"), std::string::npos) << e.what();
  }
}

}  // namespace scene_file_test
}  // namespace filum
