// Gains of the instruments: one number for all records of an output, in the fit, in the score tests and in the repetitions.

#include <gtest/gtest.h>

#include <algorithm>

#include "base/rng.h"
#include "reconcile/score_tests.h"

namespace filum::reconcile {
namespace fit_test {

/// A thread let out and drawn back four times, twice with each side down; drop and reach read by two instruments with errors of gain of their own.
Dataset thread_with_gains(double drop, double reach, double noise) {
  Dataset d;
  d.rig = Rig::suture_cantilever;
  for (const ParameterInfo& p : info(d.rig).baseline) d.nominal[p.name] = p.nominal, d.free.push_back(p.name);
  d.outputs = {"tip_drop", "tip_reach"};
  for (const ChannelInfo& c : info(d.rig).channels) d.channels.push_back({c.name, c.name, c.unit, 1.0, 0.0, c.input, 0.0});
  Rng rng(5);
  for (int i = 0; i < 4; ++i) {
    Trial t;
    t.file = std::string(1, static_cast<char>('a' + i)) + ".csv";
    t.specimen = {{"diameter", 30e-6}, {"density", 1140.0}};
    t.protocol["orientation"] = i % 2 == 0 ? "down" : "up";
    t.clocked = true;
    t.time = Eigen::VectorXd::LinSpaced(60, 0.0, 600.0);
    t.data["overhang"] = (14e-3 + 26e-3 * t.time.array() / 600.0).matrix();
    t.data["tip_drop"] = t.data["tip_reach"] = Eigen::VectorXd::Zero(60);
    d.trials.push_back(t);
  }
  const auto model = make_model(d);
  const double E = 2.5e9, gains[] = {drop, reach};
  Setting s;
  s.base = &E;
  s.instrument = gains;
  for (Trial& t : d.trials) {
    Eigen::MatrixXd out;
    model->simulate(t, s, out);
    for (int c = 0; c < 2; ++c)
      for (Eigen::Index n = 0; n < out.rows(); ++n) t.data[d.outputs[static_cast<std::size_t>(c)]][n] = out(n, c) + noise * rng.normal();
  }
  return d;
}

Noise noise_of(const RigModel& model, double sigma) {
  Noise noise;
  for (const std::string& name : model.data().outputs) noise.output.push_back({sigma, 0.0, model.full_scale(name), "stated"});
  return noise;
}

TEST(Fit, TheGainOfASecondInstrumentIsFoundAsOneNumber) {
  const double sigma = 1e-4;
  const Dataset d = thread_with_gains(1.0, 1.008, sigma);
  const auto model = make_model(d);
  const Fitter fitter(*model, noise_of(*model, sigma));
  const Fit f = fitter.fit({}, model->guess(), {});
  const double sd = std::sqrt(f.covariance(f.covariance.rows() - 1, f.covariance.rows() - 1));
  EXPECT_NEAR(std::log(f.instrument[1]), std::log(1.008), 2.0 * sd);
  EXPECT_LT(sd, 0.7 * fitter.noise().gain_scatter);  // the records say more of it than is known beforehand
  EXPECT_NEAR(f.chi2 / f.samples, 1.0, 0.15);  // 480 samples: 0.065 is one standard deviation
  for (const double g : f.log_gain) EXPECT_NEAR(g, 0.0, 2e-3);
}

/// The reach of a thread that is let out grows with time: an error of its gain is no drift.
/// As of held-out records: where nothing else is free, a record's own gain is still fitted.
TEST(Fit, AGainIsFoundWhereNothingElseIsFree) {
  const double sigma = 1e-6;
  Dataset d = thread_with_gains(1.01, 1.0, sigma);
  d.outputs = {"tip_drop"};
  d.free.clear();
  const auto model = make_model(d);
  const Fitter fitter(*model, noise_of(*model, sigma));
  const Fit f = fitter.fit({}, model->guess(), {});
  for (const double gain : f.log_gain) EXPECT_NEAR(gain, std::log(1.01), 2e-4);
}

TEST(Fit, TheGainOfASecondInstrumentPromisesNoDrift) {
  const double sigma = 3e-5;
  const Dataset d = thread_with_gains(0.992, 1.005, sigma), drifting = [&] {
    Dataset out = thread_with_gains(1.0, 1.0, sigma);
    for (Trial& t : out.trials) t.data["tip_reach"] += 1e-3 * t.time / 600.0;
    return out;
  }();
  const auto promised = [&](const Dataset& data) {
    const auto model = make_model(data);
    const Fitter fitter(*model, noise_of(*model, sigma));
    const Fit f = fitter.fit({}, model->guess(), {});
    const auto forms = model->all_forms();
    double most = 0.0;
    for (const Score& s : ScoreTests(fitter, f).all(forms))
      if (s.form->effect == Effect::sensor_drift) most = std::max(most, s.gain);
    return most;
  };
  EXPECT_LT(promised(d), 10.0);  // what a name must bring (Rules::accept_evidence); more than 100 where the gains are not fitted
  EXPECT_GT(promised(drifting), 100.0);
}

/// A score test is the first step of the fit: where the gains' prior pulls (it does wherever they are not 1), both must fall alike.
TEST(Fit, AScoreTestBesideAGainPromisesWhatTheFitKeeps) {
  const double sigma = 3e-5;
  Dataset d = thread_with_gains(0.992, 1.005, sigma);
  for (Trial& t : d.trials) t.data["tip_reach"] += 1e-4 * t.time / 600.0;
  const auto model = make_model(d);
  const Fitter fitter(*model, noise_of(*model, sigma));
  const Fit without = fitter.fit({}, model->guess(), {}, {60, 1e-9});
  const auto forms = model->all_forms();
  const auto drift = std::find_if(forms.begin(), forms.end(), [](const Form& f) { return f.text == "tip_reach: offset linear in time"; });
  ASSERT_NE(drift, forms.end());
  const Score s = ScoreTests(fitter, without).score(*drift, drift->starts[0]);
  const Fit with = fitter.fit({&*drift}, without.base, {drift->starts[0]}, {60, 1e-9}, &without);
  EXPECT_GT(s.gain, 10.0);
  EXPECT_NEAR(s.gain / (without.chi2 - with.chi2), 1.0, 0.01);
}

}  // namespace fit_test
}  // namespace filum::reconcile
