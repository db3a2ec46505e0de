// model.yaml: what was named, ready for a scene; what belongs to the laboratory is written off; whatever a dataset's folder is called, the file is YAML.

#include <gtest/gtest.h>

#include "base/yaml_file.h"
#include "reconcile/full_solver.h"
#include "reconcile/report.h"

namespace filum::reconcile {
namespace model_yaml_test {

struct Written {
  Written(Rig rig, const std::vector<Effect>& effects) {
    d.rig = rig;
    d.model = info(rig).model;
    d.name = "a \"quoted\" name: with \\ and #";
    Trial t;
    t.time = Eigen::VectorXd::LinSpaced(10, 0.0, 1.0);
    t.specimen = {{"length", 0.06}, {"width", 0.05}, {"height", 0.02}, {"blade_length", 0.014}, {"blade_width", 0.007}};
    d.trials.push_back(t);
    r.decide.verdict = "effect";
    r.decide.baseline = {{"youngs_modulus", "Pa", 1000.0, 900.0, 1100.0}, {"poissons_ratio", "-", 0.45, 0.44, 0.46}};
    for (const Effect e : effects) r.decide.effects.push_back({e, "Yeoh", {{"c20_over_c10", "-", 3.0, 2.0, 4.0}}});
  }
  YamlNode read() const { return YamlNode::parse(model_yaml(d, r, "filum"), "model.yaml"); }
  Dataset d;
  Result r;
};

TEST(ModelYaml, ABladesLawGoesWithTheTissuesOwnStrain) {
  const Written w(Rig::spatula_press, {Effect::strain_stiffening});
  const YamlNode file = w.read();
  EXPECT_EQ(file.text("title"), w.d.name);
  EXPECT_EQ(file.map("source").text("dataset"), w.d.name);
  const YamlNode effect = file.items("effects").at(0);
  EXPECT_TRUE(effect.flag("on"));
  const double square = local_strain_square(pressed_box(Vec3(0.06, 0.05, 0.02), 0.014, 0.007, 2), 0.02, 0.45);
  EXPECT_NEAR(effect.number("local_strain_square"), square, 1e-4 * square);
  EXPECT_GT(square, 0.01);
  // the values of the mesh, where the blade's own solver accepted the name
  Written meshed = w;
  meshed.r.confirm.emplace();
  meshed.r.confirm->holds = true;
  meshed.r.confirm->values = {{Effect::strain_stiffening, "Yeoh", {{"c20_over_c10", "-", 5.0, 4.0, 6.0}}}};
  EXPECT_EQ(meshed.read().items("effects").at(0).map("parameters").map("c20_over_c10").number("value"), 5.0);
  meshed.r.confirm->holds = false;
  EXPECT_EQ(meshed.read().items("effects").at(0).map("parameters").map("c20_over_c10").number("value"), 3.0);
}

TEST(ModelYaml, WhatIsTheLaboratorysIsOffWithItsReason) {
  const Written w(Rig::tissue_block, {Effect::strain_stiffening, Effect::sensor_lag, Effect::saturation, Effect::sensor_drift, Effect::mains_hum, Effect::rig_compliance, Effect::hysteresis, Effect::platen_friction, Effect::pulsation});
  const auto effects = w.read().items("effects");
  ASSERT_EQ(effects.size(), 9u);
  for (std::size_t i = 0; i < effects.size(); ++i) {
    const bool own = i == 0 || i == 8;
    EXPECT_EQ(effects[i].flag("on"), own) << effects[i].text("name");
    EXPECT_EQ(effects[i].has("note"), !own) << effects[i].text("name");
    EXPECT_FALSE(effects[i].has("local_strain_square"));
    EXPECT_EQ(effects[i].text_or("note", "off: ").rfind("off: ", 0), 0u);
  }
  // a forceps' calibration is its sensor
  EXPECT_TRUE(Written(Rig::forceps_bridge, {Effect::hysteresis}).read().items("effects").at(0).flag("on"));
}

}  // namespace model_yaml_test
}  // namespace filum::reconcile
