// Long records are thinned behind a low-pass: what is slow stays as it is, what is fast goes, and nothing folds onto what stays.

#include "reconcile/thin.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/error.h"
#include "base/rng.h"

namespace filum::reconcile {
namespace thin_test {

constexpr int kEvery = 20, kLong = 20000;

Eigen::VectorXd wave(double of_new_rate, double phase = 0.3) {
  Eigen::VectorXd v(kLong);
  for (Eigen::Index k = 0; k < v.size(); ++k) v[k] = std::sin(2.0 * std::numbers::pi * of_new_rate * static_cast<double>(k) / kEvery + phase);
  return v;
}

double rms(const Eigen::VectorXd& v) { return std::sqrt(v.squaredNorm() / static_cast<double>(v.size())); }

TEST(Thin, WhatIsSlowStaysAndWhatIsFastGoes) {
  for (const double f : {0.01, 0.1, 0.3, 0.39}) {
    const Eigen::VectorXd all = wave(f), left = thinned(all, kEvery);
    ASSERT_EQ(left.size(), kLong / kEvery);
    double worst = 0.0;
    for (Eigen::Index n = 20; n < left.size() - 20; ++n) worst = std::max(worst, std::abs(left[n] - all[n * kEvery]));
    EXPECT_LT(worst, 2e-3) << f;
  }
  for (const double f : {0.63, 0.7, 1.0, 1.3, 4.9}) EXPECT_LT(rms(thinned(wave(f), kEvery).segment(20, kLong / kEvery - 40)), 2e-3) << f;
}

TEST(Thin, WhatIsStraightStaysStraightUpToTheEnds) {
  const Eigen::VectorXd line = Eigen::VectorXd::LinSpaced(kLong, 3.0, -4.0), left = thinned(line, kEvery);
  for (Eigen::Index n = 0; n < left.size(); ++n) EXPECT_NEAR(left[n], line[n * kEvery], 1e-9) << n;
}

/// Of white noise's power 1/m is left, and it is as white as before: neighbours have nothing in common (a low-pass that ends at half the rate would leave -0.1).
/// It is no larger at the ends than elsewhere.
TEST(Thin, WhiteNoiseStaysWhite) {
  Rng rng(3);
  constexpr int kRecords = 200;
  Eigen::VectorXd inside(kRecords), ends(kRecords), v(kLong), common = Eigen::VectorXd::Zero(4);
  for (Eigen::Index i = 0; i < kRecords; ++i) {
    for (double& x : v) x = rng.normal();
    const Eigen::VectorXd left = thinned(v, kEvery);
    ends[i] = left[0], inside[i] = left[left.size() / 2];
    const Eigen::Index n = left.size() - 100;
    for (Eigen::Index lag = 0; lag < 4; ++lag) common[lag] += kEvery * left.segment(50, n).dot(left.segment(50 + lag, n)) / static_cast<double>(n * kRecords);
  }
  EXPECT_NEAR(common[0], 1.0, 0.02);
  for (Eigen::Index lag = 1; lag < 4; ++lag) EXPECT_NEAR(common[lag], 0.0, 0.01) << lag;
  EXPECT_LT(rms(ends), 1.4 * rms(inside));
}

TEST(Thin, AMissingStretchStaysMissing) {
  Eigen::VectorXd v = Eigen::VectorXd::LinSpaced(kLong, 0.0, 1.0);
  v.segment(4000, 30 * kEvery).setConstant(NAN);
  v[9001] = NAN;
  const Eigen::VectorXd left = thinned(v, kEvery);
  EXPECT_TRUE(std::isnan(left[200 + 15]));
  EXPECT_NEAR(left[450], 0.45, 1e-4);
  EXPECT_NEAR(left[150], 0.15, 1e-4);
}

Dataset recorded(int samples, int trials) {
  Dataset d;
  d.channels = {{"force", "F", "N", 1.0, 0.0, false, 0.1}};
  d.outputs = {"force"};
  for (int i = 0; i < trials; ++i) {
    Trial t;
    t.file = std::to_string(i) + ".csv";
    t.time = Eigen::VectorXd::LinSpaced(samples, 0.0, 0.001 * (samples - 1));
    t.data["force"] = t.time.array().sin();
    d.trials.push_back(t);
  }
  return d;
}

TEST(Thin, ADatasetIsThinnedToWhatIsFittedAndSaysSo) {
  Dataset d = recorded(5000, 2);
  thin(d, 10000);
  EXPECT_EQ(d.trials[0].samples(), 5000);
  EXPECT_TRUE(d.notices.empty());
  thin(d, 3000);
  EXPECT_EQ(d.trials[1].samples(), 1250);
  EXPECT_NEAR(d.trials[1].time[1] - d.trials[1].time[0], 0.004, 1e-9);
  EXPECT_NEAR(d.trials[1].at("force")[600], std::sin(2.4), 1e-4);
  EXPECT_EQ(d.thinned, 4);
  EXPECT_FALSE(hum_is_gone(d));  // 250 Hz are left
  EXPECT_EQ(d.channels[0].noise, 0.0);  // what was stated is that of a sample before
  ASSERT_EQ(d.notices.size(), 1u);
  EXPECT_NE(d.notices[0].find("thinned to one in 4"), std::string::npos) << d.notices[0];
  thin(d, 200);
  EXPECT_TRUE(hum_is_gone(d));  // 19 Hz are
  Dataset uneven = recorded(20000, 1);
  uneven.trials.push_back(recorded(100, 1).trials[0]);
  EXPECT_THROW(thin(uneven, 3000), InputError);
}

/// A clock that stands for an hour: behind the low-pass it would run backwards.
TEST(Thin, AClockWithAJumpStaysInOrder) {
  Dataset d = recorded(20000, 1);
  for (Eigen::Index k = 9990; k < 20000; ++k) d.trials[0].time[k] += 3600.0;
  thin(d, 1000);
  for (Eigen::Index k = 1; k < d.trials[0].time.size(); ++k) EXPECT_GT(d.trials[0].time[k], d.trials[0].time[k - 1]);
}

}  // namespace thin_test
}  // namespace filum::reconcile
