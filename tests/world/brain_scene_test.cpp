#include "world/brain_scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>

#include "base/error.h"
#include "world/brain_file.h"
#include "world/model.h"
#include "world/state.h"
#include "world/world.h"

namespace filum {
namespace brain_scene_test {

std::shared_ptr<const Model> scene(const std::string& task) { return load_model(FILUM_SOURCE_DIR, task); }

Inputs inputs_at(const World& world, const Vec3& moved) {
  Inputs in;
  for (int i = 0; i < world.description().n_tools; ++i) {
    ToolInput& tool = in.tools[static_cast<std::size_t>(i)];
    tool.X_WD = world.model().brain->blade_start[static_cast<std::size_t>(i)];
    tool.X_WD.p += moved;
    tool.valid = true;
  }
  return in;
}

/// Down to `depth` [m] below the start at 8 mm/s.
void press(World& world, double depth, int steps) {
  for (int k = 1; k <= steps; ++k) world.step(inputs_at(world, Vec3(0, 0, -depth * std::min(1.0, k * 0.005 * 8e-3 / depth))));
}

TEST(BrainScene, PressingRaisesForceAndPressureTogether) {
  World world(scene("press-to-target"));
  press(world, 11e-3, 320);
  const BladeObservation& blade = world.observation().brain.blades[0];
  EXPECT_GT(blade.force_W.z(), 0.1);
  EXPECT_GT(blade.contacts, 5);
  EXPECT_GT(blade.peak, blade.mean);
  EXPECT_NEAR(blade.mean * blade.area, blade.force_W.norm(), 0.6 * blade.force_W.norm());  // F = P A, area at the border in part
  EXPECT_LT((blade.push_W + blade.turn_W).norm(), 3.0 * blade.force_W.norm());
}

TEST(BrainScene, ABladeBroughtInFastComesToRest) {
  for (const double depth : {11e-3, 13e-3, 15e-3, 18.5e-3}) {  // 3 to 10.5 mm into the tissue, at 0.3 m/s
    World world(scene("press-to-target"));
    double least = 1e9, most = 0.0;
    for (int k = 1; k <= 240; ++k) {
      world.step(inputs_at(world, Vec3(0, 0, -std::min(depth, 0.3 * 0.005 * k))));
      if (k <= 160) continue;
      least = std::min(least, world.observation().brain.blades[0].force_W.z());
      most = std::max(most, world.observation().brain.blades[0].force_W.z());
    }
    EXPECT_GT(least, 0.1);
    EXPECT_LT(most - least, 0.01 * most) << depth;
  }
}

TEST(BrainScene, SameInputsGiveTheSameStatesAndARestoredStateGoesOnTheSame) {
  World a(scene("press-to-target")), b(scene("press-to-target"));
  press(a, 11e-3, 200);
  press(b, 11e-3, 200);
  ASSERT_EQ(a.state_hash(), b.state_hash());
  const State kept = a.state();
  press(a, 9e-3, 40);
  b.restore(kept);
  press(b, 9e-3, 40);
  EXPECT_EQ(a.state_hash(), b.state_hash());
}

/// Asks for the next form with the button held for two steps; returns what was said.
std::string ask_for_form(World& world, const Vec3& moved) {
  std::string said;
  for (const std::uint32_t buttons : {2u, 2u, 0u}) {
    Inputs in = inputs_at(world, moved);
    in.tools[0].buttons = buttons;
    world.step(in);
    for (int k = 0; k < world.observation().n_events; ++k)
      if (const std::string name = world.observation().events[static_cast<std::size_t>(k)].name; name.starts_with("blade-")) said += name + " ";
  }
  return said;
}

TEST(BrainScene, ABladeIsChangedOffTheTissueOnly) {
  World world(scene("press-to-target")), again(scene("press-to-target"));
  const auto& forms = world.description().brain.blades;  // one blade: its forms
  ASSERT_EQ(forms.size(), 4u);
  for (const std::size_t form : {1u, 2u, 3u, 0u, 1u, 2u}) {
    EXPECT_EQ(ask_for_form(world, Vec3::Zero()), "blade-changed ");
    EXPECT_EQ(world.observation().tools[0].grasped_edge, static_cast<int>(form));
  }
  EXPECT_EQ(forms[2].width, 15e-3);
  press(world, 11e-3, 320);
  ASSERT_GT(world.observation().brain.blades[0].contacts, 0);
  const double wide = world.observation().brain.blades[0].force_W.z();
  EXPECT_EQ(ask_for_form(world, Vec3(0, 0, -11e-3)), "blade-change-refused ") << "it presses";
  EXPECT_EQ(world.observation().tools[0].grasped_edge, 2);
  press(world, 7e-3, 200);
  EXPECT_EQ(world.observation().brain.blades[0].contacts, 0);
  EXPECT_EQ(ask_for_form(world, Vec3(0, 0, -7e-3)), "blade-change-refused ") << "a millimetre above the tissue, to which it could be bent";
  EXPECT_EQ(ask_for_form(world, Vec3::Zero()), "blade-changed ");
  // a state goes on with its form, in another world too
  const State kept = world.state();
  again.restore(kept);
  press(world, 11e-3, 320);
  press(again, 11e-3, 320);
  EXPECT_EQ(world.state_hash(), again.state_hash());
  EXPECT_EQ(again.observation().tools[0].grasped_edge, 3);
  EXPECT_NE(world.observation().brain.blades[0].force_W.z(), wide);
}

TEST(BrainScene, ABladeOnItsArmStaysAndASilentOneToo) {
  World world(scene("press-to-target"));
  press(world, 9e-3, 240);
  const Vec3 place = world.observation().tools[0].X_WT.p;
  Inputs in = inputs_at(world, Vec3(0, 0, 0.02));
  in.tools[0].buttons = 1;
  for (int k = 0; k < 20; ++k) world.step(in);
  EXPECT_TRUE(world.observation().brain.blades[0].parked);
  EXPECT_LT((world.observation().tools[0].X_WT.p - place).norm(), 1e-12);
  in.tools[0].valid = false;
  for (int k = 0; k < 20; ++k) world.step(in);
  EXPECT_LT((world.observation().tools[0].X_WT.p - place).norm(), 1e-12);
  EXPECT_FALSE(world.observation().tools[0].input_valid);
}

TEST(BrainScene, AMetreDeepTenMetresASecondAndNaNGiveSafeForces) {
  World world(scene("press-to-target"));
  for (int k = 0; k < 60; ++k) world.step(inputs_at(world, Vec3(0, 0, -0.05 * k)));  // 10 m/s
  for (int k = 0; k < 60; ++k) world.step(inputs_at(world, Vec3(0, 0, -1.0)));
  const Observation& o = world.observation();
  EXPECT_TRUE(o.brain.positions.allFinite());
  EXPECT_LE(o.tools[0].f_T_W.norm(), world.model().brain->strongest * (1.0 + 1e-9));
  Inputs bad = inputs_at(world, Vec3::Zero());
  bad.tools[0].X_WD.p.x() = std::numeric_limits<double>::quiet_NaN();
  world.step(bad);
  EXPECT_TRUE(o.tools[0].X_WT.finite());
  EXPECT_FALSE(o.tools[0].input_valid);
}

TEST(BrainScene, TwoBladesOpenTheFissure) {
  World world(scene("sylvian-opening"));
  const auto go = [&](double y, double z, int steps) {
    const Vec3 from = world.observation().tools[1].X_WD.p;
    for (int k = 1; k <= steps; ++k) {
      Inputs in = inputs_at(world, Vec3::Zero());
      const Vec3 p = from + (Vec3(0, y, z) - from) * (double(k) / steps);
      in.tools[0].X_WD.p = Vec3(p.x(), -p.y(), p.z());
      in.tools[1].X_WD.p = p;
      world.step(in);
    }
  };
  go(0.3e-3, -17e-3, 120);
  const double closed = world.observation().brain.exposed;
  go(5e-3, -17e-3, 200);
  EXPECT_GT(world.observation().brain.exposed, closed + 0.3);
  EXPECT_EQ(world.observation().brain.veins_torn, 0);
  EXPECT_LT(world.observation().brain.blades[0].force_W.y() * world.observation().brain.blades[1].force_W.y(), 0.0);
}

TEST(BrainScene, BadFilesAreRefusedByName) {
  EXPECT_THROW(load_brain_scene(FILUM_SOURCE_DIR, "knot-square", ""), InputError);
  EXPECT_THROW(load_brain_scene(FILUM_SOURCE_DIR, "press-to-target", std::string(FILUM_SOURCE_DIR) + "/models/spatula/straight-10.yaml"), InputError);
  EXPECT_THROW(load_blade(std::string(FILUM_SOURCE_DIR) + "/models/brain/convexity.yaml"), InputError);
}

TEST(BrainScene, ImpossibleTissueIsRefusedByField) {
  std::ifstream file(std::string(FILUM_SOURCE_DIR) + "/models/brain/convexity.yaml");
  const std::string good{std::istreambuf_iterator<char>(file), {}};
  const std::string path = testing::TempDir() + "filum_bad_brain.yaml";
  const auto refused = [&](const std::string& from, const std::string& to) {
    std::string bad = good;
    const std::size_t at = bad.find(from);
    if (at == std::string::npos) return "no " + from;
    std::ofstream(path) << bad.replace(at, from.size(), to);
    try {
      load_brain_scene(FILUM_SOURCE_DIR, "press-to-target", path);
    } catch (const InputError& e) {
      return e.field;
    }
    return std::string("taken");
  };
  const auto names = [](const std::string& field, const char* name) { return field.find(name) != std::string::npos; };
  EXPECT_PRED2(names, refused("poisson: { value: \"0.45\"", "poisson: { value: \"0.5\""), "poisson");
  EXPECT_PRED2(names, refused("value: \"1040 kg/m3\"", "value: \"-1040 kg/m3\""), "density");
  EXPECT_PRED2(names, refused("value: \"2.9 kPa\"", "value: \"nan kPa\""), "young");
  EXPECT_PRED2(names, refused("value: \"2.9 kPa\"", "value: \"2.9 mm\""), "young");
  EXPECT_PRED2(names, refused("reach: \"6.5 mm\"", "reach: \"-1 mm\""), "reach");
  const std::string vein = "\nveins:\n  - { cortex: [\"12 m\", \"0 mm\", \"0 mm\"], dura: [\"0 mm\", \"0 mm\", \"4 mm\"], slack: 1.6, stiffness: \"8 N/m\", strength: \"0.1 N\", source: test }\n";
  EXPECT_PRED2(names, refused("reach: \"6.5 mm\"", "reach: \"6.5 mm\"" + vein), "cortex");
}

}  // namespace brain_scene_test
}  // namespace filum
