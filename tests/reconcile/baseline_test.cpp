// Several starts of the baseline: a stub of a rig whose misfit has two optima, the nearer one to the first guess the worse.

#include "reconcile/baseline.h"

#include <gtest/gtest.h>

namespace filum::reconcile {
namespace baseline_test {

Dataset record() {
  Dataset d;
  d.rig = Rig::tissue_block;
  d.nominal = {{"youngs_modulus", 1000.0}, {"poissons_ratio", 0.49}};
  d.free = {"youngs_modulus"};
  d.outputs = {"force"};
  d.channels = {{"force", "F", "N", 1.0, 0.0, false, 0.0}};
  Trial t;
  t.file = "a.csv";
  t.time = Eigen::VectorXd::LinSpaced(50, 0.0, 10.0);
  t.data["force"] = Eigen::VectorXd::Zero(50);
  d.trials.push_back(t);
  return d;
}

/// Says h(x) at every sample, x = log(E/1 kPa): 0 at x = log 5, and a dip that does not reach 0 at x = 0, whose middle is where the guess stands.
class TwoOptima : public RigModel {
 public:
  explicit TwoOptima(const Dataset& d, double guess = 1000.0) : RigModel(d), guess_(guess) {}
  std::vector<double> guess() const override { return {guess_, 0.49}; }
  std::vector<Form> forms() const override { return {}; }
  bool has_scale() const override { return false; }
  void rig(const Trial& t, const Setting& s, Eigen::MatrixXd& out) const override {
    const double x = std::log(s.base[0] / 1000.0), far = x - std::log(5.0);
    out = Eigen::MatrixXd::Constant(t.samples(), 1, std::min(std::sqrt(0.05 + x * x), std::abs(far)));
  }

 private:
  double guess_;
};

Noise unit_noise() {
  Noise n;
  n.output.push_back({0.1, 0.0, 1.0, "stated"});
  return n;
}

TEST(Baseline, AWorseOptimumAtTheGuessIsLeft) {
  const Dataset d = record();
  const TwoOptima model(d);
  const Fitter fitter(model, unit_noise());
  const Fit alone = fitter.fit({}, model.guess(), {});
  EXPECT_NEAR(alone.base[0], 1000.0, 20.0);  // one start stays in the dip
  BaselineSummary summary;
  const Fit best = best_start(fitter, model.guess(), nullptr, 1, {}, summary);
  EXPECT_NEAR(best.base[0], 5000.0, 50.0);
  EXPECT_LT(best.chi2, 1.0);
  ASSERT_EQ(summary.starts.size(), 3u);
  EXPECT_LT(summary.same(), 3);
  EXPECT_FALSE(summary.starts[0].same);  // that of the guess
  EXPECT_TRUE(summary.starts[2].same);   // five times it
}

TEST(Baseline, StartsKeepToThePriorAndAnswersDoNotDependOnThreads) {
  Dataset d = record();
  d.prior["youngs_modulus"] = {500.0, 3000.0};
  const TwoOptima model(d);
  const Fitter fitter(model, unit_noise());
  const auto starts = baseline_starts(fitter, model.guess(), {});
  ASSERT_EQ(starts.size(), 3u);
  EXPECT_EQ(starts[0][0], 1000.0);
  EXPECT_EQ(starts[1][0], 500.0);
  EXPECT_EQ(starts[2][0], 3000.0);
  EXPECT_EQ(starts[1][1], 0.49);  // not free: stays
  BaselineSummary one, two;
  const Fit a = best_start(fitter, model.guess(), nullptr, 1, {}, one), b = best_start(fitter, model.guess(), nullptr, 3, {}, two);
  EXPECT_EQ(a.base, b.base);
  EXPECT_EQ(one.same(), two.same());
}

TEST(Baseline, WithNothingFreeThereIsOneStart) {
  Dataset d = record();
  d.free.clear();
  const TwoOptima model(d);
  const Fitter fitter(model, unit_noise());
  BaselineSummary summary;
  EXPECT_EQ(best_start(fitter, model.guess(), nullptr, 1, {}, summary).base[0], 1000.0);
  EXPECT_TRUE(summary.starts.empty());
}

/// A thread that slides over a cylinder at four wrap angles; friction differs from record to record.
Dataset slides() {
  Dataset d;
  d.rig = Rig::suture_pull;
  for (const ParameterInfo& p : info(d.rig).baseline) d.nominal[p.name] = p.nominal, d.free.push_back(p.name);
  d.outputs = {"pull_force"};
  for (const ChannelInfo& c : info(d.rig).channels) d.channels.push_back({c.name, c.name, c.unit, 1.0, 0.0, c.input, 0.0});
  for (int i = 0; i < 4; ++i) {
    Trial t;
    t.file = std::string(1, static_cast<char>('a' + i)) + ".csv";
    t.specimen = {{"diameter", 30e-6}, {"cylinder_diameter", 4e-3}};
    t.time = Eigen::VectorXd::LinSpaced(80, 0.0, 20.0);
    t.data["speed"] = Eigen::VectorXd::Constant(80, 1e-3);
    t.data["hold_force"] = Eigen::VectorXd::LinSpaced(80, 0.01, 0.05);
    t.data["wrap_angle"] = Eigen::VectorXd::Constant(80, 1.6 * (1 + i));
    t.data["pull_force"] = (t.data["hold_force"].array() * std::exp(0.25 * (1.0 + 0.03 * (i % 2)) * 1.6 * (1 + i))).matrix();
    d.trials.push_back(t);
  }
  return d;
}

/// Far off, the records' own scales would take up the misfit of what all have in common, and crawl back: they wait until that has been found.
TEST(Baseline, AStartFiveTimesOffComesBack) {
  const Dataset d = slides();
  const auto model = make_model(d);
  Noise noise;
  noise.output.push_back({1e-4, 0.0, model->full_scale("pull_force"), "stated"});
  const Fitter fitter(*model, noise);
  BaselineSummary summary;
  const Fit best = best_start(fitter, {0.25}, nullptr, 1, {}, summary);
  EXPECT_NEAR(best.base[0], 0.25 * 1.015, 0.004);  // every other record 3 % higher
  EXPECT_EQ(summary.same(), 3);
}

}  // namespace baseline_test
}  // namespace filum::reconcile
