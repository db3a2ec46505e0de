#include "world/measured_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "base/error.h"
#include "world/brain_model.h"
#include "world/model.h"
#include "world/state.h"
#include "world/world.h"

namespace filum {
namespace measured_model_test {

/// A model file in a folder of its own, gone with the test.
class MeasuredModelTest : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (std::filesystem::temp_directory_path() / "filum-model-XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string file(const std::string& rig, const std::string& baseline, const std::string& effects, const std::string& top = "") {
    const std::string path = (folder_ / "model.yaml").string();
    std::ofstream(path) << "format: filum-model/1\ntitle: \"t\"\nrig: " << rig << "\nbaseline_model: brain/linear\n" << top << "baseline: " << baseline << "\neffects:" << effects
                        << "\npartial: false\nvalid_for:\n  time: [\"0 s\", \"60 s\"]\nsource: { dataset: \"d\", hash: \"0\", program: \"p\" }\n";
    return path;
  }
  static std::string relaxing(const std::string& extra = "") {
    return "\n  - name: viscoelastic-relaxation\n    form: \"one exponential\"\n" + extra +
           "    parameters:\n      g1: { value: \"0.4\", low: \"0.38\", high: \"0.42\" }\n      tau1: { value: \"0.5 s\", low: \"0.4 s\", high: \"0.6 s\" }\n";
  }
  std::filesystem::path folder_;
};

std::shared_ptr<const Model> scene(const std::string& task, const std::string& file = "") { return load_model(FILUM_SOURCE_DIR, task, file); }

Inputs inputs_at(const World& world, double down) {
  Inputs in;
  for (int i = 0; i < world.description().n_tools; ++i) {
    ToolInput& tool = in.tools[static_cast<std::size_t>(i)];
    tool.X_WD = world.model().brain ? world.model().brain->blade_start[static_cast<std::size_t>(i)] : world.model().instrument_start[static_cast<std::size_t>(i)];
    tool.X_WD.p.z() -= down;
    tool.valid = true;
  }
  return in;
}

void run(World& world, double seconds, double down) {
  const double dt = world.description().dt;
  for (int k = 0; k < static_cast<int>(std::lround(seconds / dt)); ++k) world.step(inputs_at(world, down));
}

/// Force on the blade [N] at every step of a press to 10.5 mm below the start at 20 mm/s and a hold, 3 s in all.
std::vector<double> retraction(const std::shared_ptr<const Model>& model) {
  World world(model);
  const double dt = world.description().dt;
  std::vector<double> force;
  for (int k = 1; k <= static_cast<int>(std::lround(3.0 / dt)); ++k) {
    world.step(inputs_at(world, std::min(10.5e-3, 20e-3 * k * dt)));
    force.push_back(world.observation().brain.blades[0].force_W.norm());
  }
  return force;
}

// F(t) = int g(t - s) dFe/ds ds with the elastic force Fe of the same retraction, as the rig of the measurement has it.
TEST_F(MeasuredModelTest, RetractionForceRelaxesAsMeasuredAndStiffnessIsTheMeasuredOne) {
  const std::string baseline = "{ youngs_modulus: { value: \"2900 Pa\", low: \"2800 Pa\", high: \"3000 Pa\" } }";
  const auto elastic = retraction(scene("press-to-target", file("tissue-block", "{ youngs_modulus: { value: \"2900 Pa\" } }",
                                                                "\n  - name: viscoelastic-relaxation\n    parameters: { g1: { value: \"0.000001\" }, tau1: { value: \"1 s\" } }")));
  const auto relaxed = retraction(scene("press-to-target", file("tissue-block", baseline, relaxing())));
  const double dt = 3.0 / static_cast<double>(elastic.size());
  double memory = 0.0, before = 0.0;
  for (std::size_t k = 0; k < elastic.size(); ++k) {
    memory = std::exp(-dt / 0.5) * (memory + 0.4 * (elastic[k] - before));
    before = elastic[k];
    // the springs at the blade's border (Hansen, Eq. 8) do not relax with the tissue: a few per cent are theirs
    EXPECT_NEAR(relaxed[k] / elastic.back(), (0.6 * elastic[k] + memory) / elastic.back(), 0.04) << "at " << static_cast<double>(k + 1) * dt << " s";
  }
  EXPECT_GT(elastic.back(), 0.25);
  EXPECT_LT(relaxed.back() / elastic.back(), 0.68);
  const auto half = retraction(scene("press-to-target", file("tissue-block", "{ youngs_modulus: { value: \"1450 Pa\" } }", relaxing())));
  EXPECT_NEAR(half.back() / relaxed.back(), 0.5, 0.02);
}

/// The elements would lock, and a blade meet 30 times the force; in a half space E/(1 - nu^2) is what it feels.
TEST_F(MeasuredModelTest, NearlyIncompressibleTissueIsPressedAsInAHalfSpace) {
  const auto retracted = [this](const std::string& poisson) {
    return retraction(scene("press-to-target", file("tissue-block", "{ youngs_modulus: { value: \"2900 Pa\" }, poissons_ratio: { value: \"" + poisson + "\" } }", " []"))).back();
  };
  EXPECT_NEAR(retracted("0.4999") / retracted("0.45"), (1.0 - 0.45 * 0.45) / (1.0 - 0.4999 * 0.4999), 0.01);
  EXPECT_LT(retracted("0.3"), retracted("0.45"));
}

TEST_F(MeasuredModelTest, WhatIsOffLeavesTheOldStatesBitForBit) {
  const std::string own = "{ youngs_modulus: { value: \"2900 Pa\" }, poissons_ratio: { value: \"0.45\" } }";
  World plain(scene("press-to-target"));
  World effect_off(scene("press-to-target", file("tissue-block", own, relaxing("    on: false\n"))));
  World file_off(scene("press-to-target", file("spatula-press", "{ youngs_modulus: { value: \"1 Pa\" } }", relaxing(), "on: false\n")));
  for (World* w : {&plain, &effect_off, &file_off}) run(*w, 1.0, 11e-3);
  EXPECT_GT(plain.observation().brain.blades[0].contacts, 0);
  EXPECT_EQ(plain.state_hash(), effect_off.state_hash());
  EXPECT_EQ(plain.state_hash(), file_off.state_hash());
  World on(scene("press-to-target", file("tissue-block", own, relaxing())));
  run(on, 1.0, 11e-3);
  EXPECT_NE(plain.state_hash(), on.state_hash());
}

TEST_F(MeasuredModelTest, FastTermsActAtOnceAndASpectrumIsTakenTermByTerm) {
  const auto m = scene("press-to-target", file("tissue-block", "{ youngs_modulus: { value: \"2000 Pa\" } }",
                                               "\n  - name: viscoelastic-relaxation\n    form: fractional\n    prony: [ { share: \"0.2\", time: \"1 ms\" }, { share: \"0.4\", time: \"30 s\" } ]\n"
                                               "    parameters: { g1: { value: \"0.6\" }, tau1: { value: \"3 s\" }, order: { value: \"0.5\" } }"));
  EXPECT_NEAR(m->brain->regions[0].young, 1600.0, 1e-9);
  ASSERT_EQ(m->brain->fem.relaxation.size(), 1u);
  EXPECT_NEAR(m->brain->fem.relaxation[0].share, 0.5, 1e-12);
}

/// Force on the blade [N] at the ends of: a press to 12 mm below the start, a return to 10 mm, a second press to 11 mm, each at 20 mm/s with 0.3 s of rest.
std::array<double, 3> two_presses(const std::shared_ptr<const Model>& model) {
  World world(model);
  const double dt = world.description().dt;
  std::array<double, 3> force{};
  double at = 0.0;
  const double to[] = {12e-3, 10e-3, 11e-3};
  for (std::size_t leg = 0; leg < 3; ++leg) {
    for (int k = 0; k < static_cast<int>(std::lround(0.9 / dt)); ++k) {
      at += std::clamp(to[leg] - at, -20e-3 * dt, 20e-3 * dt);
      world.step(inputs_at(world, at));
    }
    force[leg] = world.observation().brain.blades[0].force_W.norm();
  }
  return force;
}

TEST_F(MeasuredModelTest, TissueStiffensSoftensAndSetsAsItsModelSays) {
  const std::string own = "{ youngs_modulus: { value: \"2900 Pa\" }, poissons_ratio: { value: \"0.45\" } }";
  const auto with = [&](const std::string& effect) { return two_presses(scene("press-to-target", file("tissue-block", own, "\n  - " + effect))); };
  const auto plain = two_presses(scene("press-to-target"));
  const auto stiff = with("{ name: strain-stiffening, form: Yeoh, parameters: { c20_over_c10: { value: \"10\" } } }");
  EXPECT_GT(stiff[0], 1.03 * plain[0]);
  EXPECT_GT(stiff[0] / plain[0], stiff[1] / plain[1]);  // more where there is more strain
  const auto soft = with("{ name: first-cycle-softening, form: exponential in the energy, parameters: { d: { value: \"0.4\" }, W0: { value: \"3 Pa\" } } }");
  EXPECT_NEAR(soft[0] / plain[0], 1.0, 0.03);           // the first way in is that of the tissue as it was
  EXPECT_LT(soft[2], 0.97 * plain[2]);
  const auto set = with("{ name: permanent-set, form: fraction of the largest past strain, parameters: { fraction: { value: \"0.15\" } } }");
  EXPECT_LT(set[1], 0.95 * plain[1]);
  EXPECT_LT(set[0], plain[0]);
  const auto compressed = with("{ name: tension-compression-asymmetry, form: Ogden, parameters: { alpha: { value: \"-12\" } } }");
  EXPECT_GT(compressed[0], 1.02 * plain[0]);
  EXPECT_GT(compressed[0] / plain[0], compressed[1] / plain[1]);
  const auto off = with("{ name: tension-compression-asymmetry, on: false, form: Ogden, parameters: { alpha: { value: \"-12\" } } }");
  EXPECT_EQ(off, plain);
}

/// What a blade measured goes by depth over height: with the tissue's own strain beside it, it is the same law as a block's.
TEST_F(MeasuredModelTest, ABladesStiffeningAndSofteningAreThoseOfTheTissueUnderIt) {
  const std::string own = "{ youngs_modulus: { value: \"2900 Pa\" }, poissons_ratio: { value: \"0.45\" } }";
  const auto with = [&](const std::string& rig, const std::string& effect) { return two_presses(scene("press-to-target", file(rig, own, "\n  - " + effect))); };
  EXPECT_EQ(with("spatula-press", "{ name: strain-stiffening, form: exponential, local_strain_square: \"0.25\", parameters: { c20_over_c10: { value: \"2\" } } }"),
            with("tissue-block", "{ name: strain-stiffening, form: exponential, parameters: { c20_over_c10: { value: \"8\" } } }"));
  EXPECT_EQ(with("spatula-press", "{ name: first-cycle-softening, form: exponential in the energy, local_strain_square: \"0.25\", parameters: { d: { value: \"0.4\" }, W0: { value: \"12 Pa\" } } }"),
            with("tissue-block", "{ name: first-cycle-softening, form: exponential in the energy, parameters: { d: { value: \"0.4\" }, W0: { value: \"3 Pa\" } } }"));
}

TEST_F(MeasuredModelTest, TissueDrainsUnderARestingBlade) {
  const std::string own = "{ youngs_modulus: { value: \"2900 Pa\" }, poissons_ratio: { value: \"0.45\" } }";
  // fluid leaves within a second or two where the blade has displaced it: the force falls, that of the faster tissue first
  const auto forces = [&](const std::string& D) {
    return retraction(scene("press-to-target", file("tissue-block", own, "\n  - { name: poroelastic-drainage, form: radial drainage, parameters: { diffusivity: { value: \"" + D + "\" }, drained_share: { value: \"0.3\" } } }")));
  };
  const auto plain = retraction(scene("press-to-target")), fast = forces("2e-5 m2/s"), slow = forces("1e-7 m2/s");
  EXPECT_LT(fast.back(), 0.9 * plain.back());
  EXPECT_GT(fast.back(), 0.35 * plain.back());
  EXPECT_GT(slow.back(), 0.9 * plain.back());
  EXPECT_LT(slow.back(), plain.back());
}

TEST_F(MeasuredModelTest, AThreadTakesItsMeasuredStiffnessFrictionAndCurl) {
  const auto plain = scene("knot-throw");
  const auto stiff = scene("knot-throw", file("suture-cantilever", "{ youngs_modulus: { value: \"5 GPa\" } }", "\n  - { name: rest-curvature, form: uniform, parameters: { curvature: { value: \"40 1/m\" } } }"));
  const double r = plain->thread.radius;
  EXPECT_NEAR(stiff->thread.EI, 5e9 * M_PI * std::pow(r, 4) / 4.0, 1e-6 * stiff->thread.EI);
  EXPECT_NEAR(stiff->thread.EA / plain->thread.EA, stiff->thread.EI / plain->thread.EI, 1e-9);
  World world(stiff);
  const RodState& s = world.state().thread;
  for (int i = 1; i + 1 < s.n; ++i)
    for (const int side : {0, 2}) EXPECT_NEAR(s.rest_kappa.col(i).segment<2>(side).norm() / (0.5 * (s.rest_length[i - 1] + s.rest_length[i])), 40.0, 1e-9);
  const auto slippery = scene("knot-throw", file("suture-pull", "{ friction_coefficient: { value: \"0.07\" } }", " []"));
  EXPECT_EQ(slippery->contact.friction, 0.07);
  World before(plain), off(scene("knot-throw", file("suture-pull", "{ friction_coefficient: { value: \"0.07\" } }", " []", "on: false\n")));
  run(before, 0.1, 0.0), run(off, 0.1, 0.0);
  EXPECT_EQ(before.state_hash(), off.state_hash());
}

TEST_F(MeasuredModelTest, WhatASceneCannotShowIsRefusedByName) {
  const auto refused = [&](const std::string& task, const std::string& path) -> std::string {
    try {
      scene(task, path);
    } catch (const InputError& e) {
      return e.field + ": " + e.value + ": " + e.expected;
    }
    return "";
  };
  const std::string stiffening = "\n  - { name: strain-stiffening, form: Yeoh, parameters: { c20_over_c10: { value: \"3\" } } }";
  EXPECT_NE(refused("press-to-target", file("spatula-press", "{}", stiffening)).find("strain-stiffening"), std::string::npos);  // by depth over height
  EXPECT_NE(refused("press-to-target", file("tissue-block", "{}", "\n  - { name: platen-friction, parameters: { friction_coefficient: { value: \"3\" } } }")).find("platen-friction"), std::string::npos);
  EXPECT_EQ(refused("press-to-target", file("spatula-press", "{}", "\n  - { name: strain-stiffening, on: false, parameters: { c20_over_c10: { value: \"3\" } } }")), "");
  // all of them at once, each with its reason
  const std::string many = refused("press-to-target", file("tissue-block", "{}", "\n  - { name: sensor-lag, parameters: { time_constant: { value: \"1 s\" } } }" + relaxing() + "  - { name: pulsation, parameters: {} }\n  - { name: contact-adhesion, parameters: {} }"));
  for (const char* said : {"sensor-lag is the sensor's, and no scene has that sensor; with `on: false` the rest runs", "pulsation would take tissue that moves with heart and breath", "contact-adhesion would take blade contacts that pull"})
    EXPECT_NE(many.find(said), std::string::npos) << many;
  EXPECT_EQ(many.find("viscoelastic-relaxation"), std::string::npos) << many;
  EXPECT_EQ(refused("press-to-target", file("tissue-block", "{}", "\n  - { name: sensor-lag, on: false, note: \"off: the sensor's\", parameters: { time_constant: { value: \"1 s\" } } }" + relaxing())), "");
  EXPECT_NE(refused("press-to-target", file("needle-insertion", "{ stiffness: { value: \"80 N/m\" } }", "\n  - { name: shaft-friction, parameters: {} }")).find("shaft-friction is of a rig that no scene stands on"), std::string::npos);
  EXPECT_NE(refused("knot-throw", file("tissue-block", "{}", relaxing())).find("suture-cantilever"), std::string::npos);
  EXPECT_NE(refused("press-to-target", file("suture-pull", "{ friction_coefficient: { value: \"0.2\" } }", " []")).find("spatula-press"), std::string::npos);
  EXPECT_NE(refused("press-to-target", file("tissue-block", "{ youngs_modulus: { value: \"-1 Pa\" } }", " []")), "");
  EXPECT_NE(refused("press-to-target", file("tissue-block", "{}", "\n  - { name: viscoelastic-relaxation, form: power, parameters: { a: { value: \"1\" } } }")), "");
  EXPECT_NE(refused("press-to-target", file("tissue-block", "{}", "\n  - { name: viscoelastic-relaxation, parameters: { g1: { value: \"0.7\" }, tau1: { value: \"1 s\" }, g2: { value: \"0.4\" }, tau2: { value: \"9 s\" } } }")), "");
}

}  // namespace measured_model_test
}  // namespace filum
