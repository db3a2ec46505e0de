// What is not named is described by every input and output; sets that are not told apart by the likeness of their signatures.

#include <gtest/gtest.h>

#include <algorithm>

#include "base/rng.h"
#include "reconcile/result.h"

namespace filum::reconcile {
namespace describe_test {

/// A thread that slides over a cylinder at four wrap angles and two speeds; `more` is added to the pull [N].
Dataset slides(const std::function<double(double hold, double wrap, double speed)>& more) {
  Dataset d;
  d.rig = Rig::suture_pull;
  for (const ParameterInfo& p : info(d.rig).baseline) d.nominal[p.name] = p.nominal, d.free.push_back(p.name);
  d.outputs = {"pull_force"};
  for (const ChannelInfo& c : info(d.rig).channels)
    if (c.name != "time") d.channels.push_back({c.name, c.name, c.unit, 1.0, 0.0, c.input, 0.0});
  Rng rng(7);
  for (int i = 0; i < 8; ++i) {
    Trial t;
    t.file = std::string(1, static_cast<char>('a' + i)) + ".csv";
    t.specimen = {{"diameter", 30e-6}, {"cylinder_diameter", 4e-3}};
    t.time = Eigen::VectorXd::LinSpaced(120, 0.0, 20.0);
    const double wrap = 1.6 * (1 + i % 4), speed = i < 4 ? 1e-3 : 5e-3;
    t.data["speed"] = Eigen::VectorXd::Constant(120, speed);
    t.data["hold_force"] = (0.03 + 0.02 * (0.3 * t.time.array()).sin()).matrix();
    t.data["wrap_angle"] = Eigen::VectorXd::Constant(120, wrap);
    t.data["pull_force"] = t.data["hold_force"] * std::exp(0.2 * wrap);
    for (Eigen::Index k = 0; k < 120; ++k) t.data["pull_force"][k] += more(t.data["hold_force"][k], wrap, speed) + 1e-4 * rng.normal();
    d.trials.push_back(t);
  }
  return d;
}

std::vector<Term> described(const Dataset& d) {
  const auto model = make_model(d);
  Noise noise;
  noise.output.push_back({1e-4, 0.0, model->full_scale("pull_force"), "stated"});
  noise.scatter = 0.01;
  const Fitter fitter(*model, noise);
  return describe(*model, fitter.fit({}, {0.2}, {}), noise);
}

TEST(Describe, AResidualThatFollowsALaterInputIsDescribedByIt) {
  const auto of_hold = described(slides([](double hold, double, double) { return 20.0 * hold * hold; }));
  ASSERT_FALSE(of_hold.empty());
  EXPECT_NE(of_hold[0].name.find("hold_force"), std::string::npos) << of_hold[0].name;
  EXPECT_EQ(of_hold[0].output, "pull_force");
  const auto of_speed = described(slides([](double, double, double speed) { return 3.0 * speed; }));
  ASSERT_FALSE(of_speed.empty());
  EXPECT_NE(of_speed[0].name.find("speed"), std::string::npos) << of_speed[0].name;
  EXPECT_GT(of_speed[0].stability, 0.6);
}

TEST(Describe, TheOutputOfWhichMoreIsLeftComesFirst) {
  Dataset d;
  d.rig = Rig::forceps_bridge;
  for (const ParameterInfo& p : info(d.rig).baseline) d.nominal[p.name] = p.nominal, d.free.push_back(p.name);
  d.outputs = {"strain_counts", "pressure_counts"};
  for (const ChannelInfo& c : info(d.rig).channels)
    if (c.name != "temperature") d.channels.push_back({c.name, c.name, c.unit, 1.0, 0.0, c.input, 0.0});
  Rng rng(2);
  for (int i = 0; i < 3; ++i) {
    Trial t;
    t.file = std::string(1, static_cast<char>('a' + i)) + ".csv";
    t.specimen = {{"bits", 12}, {"reference", 3.3}};
    t.time = Eigen::VectorXd::LinSpaced(200, 0.0, 20.0);
    t.data["angle"] = (0.2 + 0.2 * (0.9 * t.time.array()).sin()).matrix();
    t.data["grip_force"] = (0.5 + 0.5 * (2.3 * t.time.array() + i).sin()).matrix();
    t.data["strain_counts"] = (1000.0 + 5730.0 * t.data["angle"].array()).matrix();
    t.data["pressure_counts"] = (100.0 + 667.0 * t.data["grip_force"].array() + 300.0 * t.data["grip_force"].array().square()).matrix();
    for (const std::string& c : d.outputs)
      for (double& v : t.data[c]) v += 3.0 * rng.normal();
    d.trials.push_back(t);
  }
  const auto model = make_model(d);
  Noise noise;
  for (const std::string& c : d.outputs) noise.output.push_back({3.0, 0.0, model->full_scale(c), "stated"});
  const Fitter fitter(*model, noise);
  const auto terms = describe(*model, fitter.fit({}, model->guess(), {}), noise);
  ASSERT_FALSE(terms.empty());
  EXPECT_EQ(terms[0].output, "pressure_counts");
  EXPECT_TRUE(terms[0].name.find("grip_force") != std::string::npos || terms[0].name.find("output") != std::string::npos) << terms[0].name;
}

/// Signatures at fitted values: a set is as itself, the table is symmetric, and what the fit sees of each is beyond the baseline's answer.
TEST(Describe, LikenessIsTheWholeTable) {
  const Dataset d = slides([](double, double, double) { return 0.0; });
  const auto model = make_model(d);
  Noise noise;
  noise.output.push_back({1e-4, 0.0, model->full_scale("pull_force"), "stated"});
  noise.scatter = 0.01;
  const Fitter fitter(*model, noise);
  const Fit base = fitter.fit({}, {0.2}, {});
  const auto forms = model->all_forms();
  std::vector<Fit> fits;
  for (const Effect e : {Effect::viscous_drag, Effect::bending_stiffness_loss, Effect::sensor_drift}) {
    const auto form = std::find_if(forms.begin(), forms.end(), [&](const Form& f) { return f.effect == e; });
    ASSERT_NE(form, forms.end());
    fits.push_back(base);
    fits.back().forms = {&*form};
    fits.back().params = {form->starts[0]};
  }
  fits.push_back(fits[0]);
  fits.back().forms.push_back(fits[1].forms[0]);
  fits.back().params.push_back(fits[1].params[0]);
  const Likeness all = ScoreTests(fitter, base).likeness({&fits[0], &fits[1], &fits[2], &fits[3]});
  ASSERT_EQ(all.correlation.rows(), 4);
  ASSERT_EQ(all.masked.size(), 4u);
  EXPECT_TRUE(all.correlation.isApprox(all.correlation.transpose(), 1e-9));
  EXPECT_TRUE(all.correlation.diagonal().isOnes(1e-12));
  EXPECT_LT(std::abs(all.correlation(0, 2)), 0.9);  // drag goes by speed, drift by time
  EXPECT_GT(std::abs(all.correlation(0, 3)) + std::abs(all.correlation(1, 3)), 0.9);  // a pair is made of its members
  for (const double m : all.masked) EXPECT_TRUE(m >= 0.0 && m < 1.0) << m;
}

}  // namespace describe_test
}  // namespace filum::reconcile
