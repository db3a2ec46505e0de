// What a needle's drops say: a rupture happens under a needle that advances, and behind a lagging sensor a drop of unknown instant
// leaves a tail of free height from whose shape alone the lag is learnt.

#include <gtest/gtest.h>

#include "base/rng.h"
#include "searched.h"

namespace filum::reconcile {
namespace needle_test {

/// Force of a needle through a membrane at 4.0 mm, k = 100 N/m, pushed to 10 mm at `speed` [m/s], held and drawn out; the sensor lags by
/// `lag` [s] (exactly, as the drop falls anywhere between two samples), `step` [N] more falls off when the needle stops.
Trial insertion(double speed, double lag, double step, std::uint64_t seed) {
  Rng rng(seed);
  Trial t;
  t.file = "run.csv";
  const double ramp = 10e-3 / speed, k = 100.0, at = (4e-3 + 1e-4 * rng.normal()) / speed;
  const int n = 400;
  t.time = Eigen::VectorXd::LinSpaced(n, 0.0, 2.4 * ramp);
  Eigen::VectorXd depth(n), v(n), force(n);
  for (int i = 0; i < n; ++i) {
    const double s = t.time[i];
    depth[i] = s < ramp ? speed * s : s < 1.4 * ramp ? 10e-3 : std::max(0.0, 10e-3 - speed * (s - 1.4 * ramp));
    v[i] = s < ramp ? speed : s < 1.4 * ramp ? 0.0 : -speed;
    // tau y' + y = k v t up to the drop, 0 after it
    const auto rise = [&](double x) { return k * speed * (x - lag * -std::expm1(-x / lag)); };
    force[i] = lag > 0.0 ? (s < at ? rise(s) : rise(at) * std::exp(-(s - at) / lag)) : (s < at ? k * speed * s : 0.0);
    if (s > at && s < ramp) force[i] += step * std::pow(s / ramp, 3);
    force[i] += 1e-3 * rng.normal();
  }
  t.data = {{"depth", depth}, {"speed", v}, {"force", force}};
  t.specimen = {{"needle_diameter", 5e-4}, {"wall_thickness", 1e-4}};
  t.clocked = true;
  return t;
}

Dataset insertions(double lag, double step) {
  Dataset d;
  d.rig = Rig::needle_insertion;
  for (const ParameterInfo& p : info(d.rig).baseline) d.nominal[p.name] = p.nominal, d.free.push_back(p.name);
  d.outputs = {"force"};
  for (const ChannelInfo& c : info(d.rig).channels) d.channels.push_back({c.name, c.name, c.unit, 1.0, 0.0, c.input, 0.0});
  for (std::uint64_t k = 0; k < 4; ++k) d.trials.push_back(insertion(k % 2 == 0 ? 2e-3 : 6e-3, lag, step, k + 1));
  return d;
}

TEST(Needle, LagIsLearntWithoutKnowingTheInstantOfTheDrop) {
  for (const double lag : {0.03, 0.08}) {
    const Dataset d = insertions(lag, 0.0);
    const auto model = make_model(d);
    const auto forms = model->all_forms();
    const auto form = std::find_if(forms.begin(), forms.end(), [](const Form& f) { return f.effect == Effect::sensor_lag && f.kind == 0; });
    ASSERT_NE(form, forms.end());
    Noise noise;
    noise.output.push_back({1e-3, 0.0, model->full_scale("force"), "stated"});
    const Fitter fitter(*model, noise);
    const Fit fit = fitter.fit({&*form}, model->guess(), {});
    EXPECT_NEAR(fit.params[0][0] / lag, 1.0, 0.03) << "the instant read off the samples made it 10-20 % too small";
  }
}

TEST(Needle, WhatFallsWhenTheNeedleStopsIsNoRupture) {
  const auto has_layers = [](const Dataset& d) {
    const auto forms = make_model(d)->all_forms();
    return std::any_of(forms.begin(), forms.end(), [](const Form& f) { return f.effect == Effect::layer_rupture; });
  };
  EXPECT_FALSE(has_layers(insertions(0.0, 0.3)));
}

/// The same through one membrane, in noise of 10 % that is slow (AR(1), 0.85): it falls here and there as far as a layer would.
TEST(Needle, EveryInstantReadOffARecordIsCounted) {
  Dataset d = insertions(0.0, 0.0);
  Rng rng(5);
  for (Trial& t : d.trials) {
    double slow = 0.0;
    for (double& y : t.data["force"]) y += 0.04 * (slow = 0.85 * slow + std::sqrt(1.0 - 0.85 * 0.85) * rng.normal());
  }
  const auto model = make_model(d);
  const auto forms = model->all_forms();
  const auto form = std::find_if(forms.begin(), forms.end(), [](const Form& f) { return f.effect == Effect::layer_rupture; });
  ASSERT_NE(form, forms.end()) << "noise this slow makes a second drop in most records: the test shows nothing otherwise";
  int further = 0;
  for (const Trial& t : d.trials) further += std::min<int>(static_cast<int>(model->drops(t).size()), 1 + static_cast<int>(form->params.size()) / 2) - 1;
  EXPECT_GE(further, 2);
  EXPECT_EQ(form->instants, further);
  const Options options;
  const Candidates sets = searched(*model, forms, options);
  for (const Fit& f : sets.fitted())
    if (f.forms.size() == 1 && f.forms[0]->effect == Effect::layer_rupture) {
      EXPECT_GT(sets.bic(f), sets.bic(sets.base())) << "noise passes for a layer";
    }
}

}  // namespace needle_test
}  // namespace filum::reconcile
