#include "world/wall_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "base/error.h"
#include "evidence/vessel_probe.h"

using namespace filum;

namespace wall_file_test {

const std::string kFolder = std::string(FILUM_SOURCE_DIR) + "/models/vessel/";

std::string text_of(const std::string& name) {
  std::stringstream s;
  s << std::ifstream(kFolder + name + ".yaml").rdbuf();
  return s.str();
}

VesselPreset load_text(const std::string& text) {
  const struct File {
    std::filesystem::path path;
    ~File() { std::filesystem::remove(path); }
  } file{std::filesystem::temp_directory_path() / ("filum_wall_file_test_" + std::to_string(getpid()) + ".yaml")};  // tests run side by side
  std::ofstream(file.path) << text;
  return load_vessel(file.path.string());
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(WallFile, EveryPresetLoadsAndMeshes) {
  for (const char* name : {"rat-femoral-artery", "rat-femoral-vein", "human-digital-artery", "silicone-tube", "chicken-artery", "latex-card"}) {
    const VesselPreset p = load_vessel(kFolder + name + ".yaml");
    ASSERT_FALSE(p.layers.empty()) << name;
    EXPECT_EQ(p.tube, std::string(name) != "latex-card");
    const VesselMesh mesh = p.tube ? make_tube(p.shape) : make_card({});
    EXPECT_NO_THROW(WallElements(mesh, p.layers)) << name;
  }
}

/// Outer diameter [mm] at the preset's pressure and stretch in the body.
double outer_diameter(const VesselPreset& p) {
  TubeSlice s;
  s.shape = p.shape;
  s.shape.length = 0.1e-3;
  s.shape.stretch = p.axial_stretch;
  s.layers = p.layers;
  s.around = 24;
  s.through = 4;
  const SliceState state = inflate(s, {0.0, 0.3 * p.pressure, p.pressure}).back();
  EXPECT_TRUE(state.converged) << p.title;
  return 2e3 * state.outer;
}
double outer_diameter(const std::string& name) { return outer_diameter(load_vessel(kFolder + name + ".yaml")); }

TEST(WallFile, DiametersAtPressureAreThoseOfTheLiterature) {
  const double artery = outer_diameter("rat-femoral-artery");
  EXPECT_GT(artery, 0.65);
  EXPECT_LT(artery, 0.90);
  const double vein = outer_diameter("rat-femoral-vein");
  EXPECT_GT(vein, 0.7);
  EXPECT_LT(vein, 1.1);
  const double human = outer_diameter("human-digital-artery");
  EXPECT_GT(human, 0.8);
  EXPECT_LT(human, 1.2);
}

TEST(WallFile, ToneNarrowsTheVessel) {
  const std::string relaxed = text_of("rat-femoral-artery"), media = "  - name: media\n    law: fibres\n";
  const std::string tone = "    tone:\n      shape: parabola\n      active_stress: { value: \"60 kPa\", uncertainty: \"30 kPa\", source: a test }\n"
                           "      stretch_of_most_tone: { value: \"1.4\", uncertainty: \"0.1\", source: a test }\n";
  const std::string text = replaced(relaxed, media, media + tone);
  const VesselPreset active = load_text(text);
  EXPECT_DOUBLE_EQ(active.layers[1].law.tone.stress, 60e3);
  EXPECT_EQ(active.layers[0].law.tone.stress, 0.0);
  const double narrow = outer_diameter(active), wide = outer_diameter("rat-femoral-artery");
  std::printf("outer diameter at pressure: %.3f mm, with tone %.3f mm\n", wide, narrow);
  EXPECT_LT(narrow, 0.97 * wide);
  EXPECT_THROW(load_text(replaced(text, "\"60 kPa\"", "\"-60 kPa\"")), InputError);
  EXPECT_THROW(load_text(replaced(text, "stretch_of_most_tone", "stretch_of_all_tone")), InputError);
  EXPECT_THROW(load_text(replaced(text, "shape: parabola", "shape: ellipse")), InputError);
}

TEST(WallFile, RefusesWhatIsWrong) {
  const std::string good = text_of("rat-femoral-artery");
  EXPECT_NO_THROW(load_text(good));
  EXPECT_THROW(load_text(replaced(good, "filum-vessel/1", "filum-vessel/9")), InputError);
  EXPECT_THROW(load_text(replaced(good, "kind: tube", "kind: sphere")), InputError);
  EXPECT_THROW(load_text(good + "colour: red\n"), InputError);
  EXPECT_THROW(load_text(replaced(good, "law: fibres", "law: jelly")), InputError);
  EXPECT_THROW(load_text(replaced(good, "\"30 kPa\"", "\"-30 kPa\"")), InputError);
  EXPECT_THROW(load_text(replaced(good, "\"30 kPa\"", "\"30 mm\"")), InputError);
  EXPECT_THROW(load_text(replaced(good, "\"2 MPa\"", "\"40 kPa\"")), InputError);
  EXPECT_THROW(load_text(replaced(good, "beta", "gamma")), InputError);
  EXPECT_THROW(load_text(replaced(good, "\"100 mmHg\"", "\"0.7 mmHg\"")), InputError) << "without pressure nothing flows";
  try {
    load_text(replaced(good, "\"90 deg\"", "\"900 deg\""));
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("opening_angle"), std::string::npos) << e.what();
  }
}

}  // namespace wall_file_test
