// The mapping of the full solver onto the reduced model, behind a sensor that clips.

#include <gtest/gtest.h>

#include <algorithm>

#include "base/rng.h"
#include "reconcile/confirm.h"

namespace filum::reconcile {
namespace confirm_test {

/// Two blades, one twice as large, pressed and drawn back; the forces are the full solver's, read by a sensor that clips at `limit` [N], with noise.
Dataset clipped_presses(double E, double limit, double noise) {
  Dataset d;
  d.rig = Rig::spatula_press;
  for (const ParameterInfo& p : info(d.rig).baseline) d.nominal[p.name] = p.nominal;
  d.free = {"youngs_modulus"};
  d.outputs = {"force"};
  for (const ChannelInfo& c : info(d.rig).channels) d.channels.push_back({c.name, c.name, c.unit, 1.0, 0.0, c.input, 0.0});
  for (const double large : {1.0, 2.0}) {
    Trial t;
    t.file = large > 1.0 ? "b.csv" : "a.csv";
    t.specimen = {{"length", 60e-3}, {"width", 50e-3}, {"height", 16e-3}, {"blade_length", 17e-3 * large}, {"blade_width", 8.5e-3 * large}};
    t.clocked = true;
    t.time = Eigen::VectorXd::LinSpaced(81, 0.0, 4.0);
    t.data["depth"] = (1.6e-3 * (1.0 - (t.time.array() / 2.0 - 1.0).abs())).matrix();
    t.data["force"] = Eigen::VectorXd::Zero(81);
    d.trials.push_back(t);
  }
  const auto model = make_model(d);
  const auto solver = make_full_solver(*model);
  std::vector<double> base = model->guess();
  base[0] = E;
  Setting s;
  s.base = base.data();
  Rng rng(3);
  for (Trial& t : d.trials) {
    Eigen::MatrixXd out;
    EXPECT_TRUE(solver->run(t, s, false, out));
    EXPECT_GT(out.maxCoeff() / limit, t.size("blade_width") > 10e-3 ? 1.1 : 0.5);
    for (Eigen::Index n = 0; n < out.rows(); ++n) t.data["force"][n] = std::min(out(n, 0), limit) + noise * rng.normal();
  }
  return d;
}

/// Where the sensor clips, the readings of both models agree and their forces do not: the difference has to be carried before the sensor.
TEST(Confirm, AClippedSensorIsFoundBehindTheFullSolverAsBehindTheReducedModel) {
  const double E = 1000.0, limit = 0.1, noise = 3e-4;
  const Dataset d = clipped_presses(E, limit, noise);
  const auto model = make_model(d);
  Noise known;
  known.output.push_back({noise, 0.0, model->full_scale("force"), "stated"});
  const Fitter fitter(*model, known);
  const auto forms = model->all_forms();
  const auto clip = std::find_if(forms.begin(), forms.end(), [](const Form& f) { return f.effect == Effect::saturation && f.text.find("above") != std::string::npos; });
  ASSERT_NE(clip, forms.end());
  const Fit reduced = fitter.fit({&*clip}, model->guess(), {});
  const FullFit full = refit_fully(fitter, *make_full_solver(*model), reduced, false);
  ASSERT_GT(full.rounds, 0);
  EXPECT_GT(full.change, 0.02);  // of full scale: without a difference of the two there would be nothing to carry
  EXPECT_NEAR(full.fit.chi2 / full.fit.samples, 1.0, 0.25);
  EXPECT_NEAR(full.fit.params[0][0] / limit, 1.0, 0.01);
  EXPECT_NEAR(full.fit.base[0] / E, 1.0, 0.03);
}

}  // namespace confirm_test
}  // namespace filum::reconcile
