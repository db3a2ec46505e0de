// Residuals made by hand, so that where they sit is known.
#include <gtest/gtest.h>

#include <numbers>

#include "base/rng.h"
#include "reconcile/result.h"
#include "records.h"

namespace filum::reconcile {
namespace localise_test {

constexpr int kSamples = 400;

/// Two records of a block that is pressed by 10 % of its height, held and let go, twice in 20 s.
Dataset pressed_twice(const Folder& f) {
  f.write("experiment.yaml", block_yaml("  - { file: a.csv, protocol: { mode: compression, cycle: \"2\" } }\n  - { file: b.csv, protocol: { mode: compression, cycle: \"2\" } }\n"));
  std::ostringstream s;
  s << "t,u,F\n";
  for (int i = 0; i < kSamples; ++i) {
    const double t = 0.05 * i, x = std::fmod(t, 10.0) / 10.0, u = -0.5 * (x < 0.3 ? x / 0.3 : x < 0.6 ? 1.0 : x < 0.9 ? (0.9 - x) / 0.3 : 0.0);
    s << t << "," << u << "," << u << "\n";
  }
  f.write("a.csv", s.str());
  f.write("b.csv", s.str());
  return load_dataset(f.path(), FILUM_SOURCE_DIR);
}

/// White noise of one standard deviation 1 mN, and 3 mN more where `there(time, strain, record)` says.
template <class There>
std::vector<Share> shares_of(There there, double line = 0.0) {
  const Folder f;
  const Dataset d = pressed_twice(f);
  const auto model = make_model(d);
  Noise noise;
  noise.output = {{1e-3, 0.0, 1.0, "stated"}};
  Fit base;
  Rng rng(3);
  for (int i = 0; i < 2; ++i) {
    const Trial& t = d.trials[static_cast<std::size_t>(i)];
    Eigen::VectorXd r(t.samples());
    for (int k = 0; k < t.samples(); ++k) {
      r[k] = 1e-3 * (rng.normal() + 2.0 * std::sin(2.0 * std::numbers::pi * line * t.time[k]));
      if (there(t.time[k], t.at("displacement")[k] / 5e-3, i)) r[k] += 3e-3;
    }
    base.residual.push_back({r});
  }
  return shares_of(*model, base, noise);
}

Share largest(const std::vector<Share>& all, const std::string& axis) {
  Share best;
  for (const Share& s : all)
    if (s.axis == axis && s.share > best.share) best = s;
  return best;
}

void expect_sum_of_one(const std::vector<Share>& all) {
  std::map<std::string, double> sum;
  for (const Share& s : all) sum[s.axis] += s.share;
  for (const auto& [axis, total] : sum) EXPECT_NEAR(total, 1.0, 1e-9) << axis;
}

TEST(Localise, FindsTheStrainWhereTheMisfitSits) {
  const auto all = shares_of([](double, double strain, int) { return strain < -0.076; });
  expect_sum_of_one(all);
  EXPECT_EQ(largest(all, "strain").bin, "-0.1 to -0.075");
  EXPECT_GT(largest(all, "strain").share, 0.9);
  EXPECT_GT(largest(all, "strain").deviations, 20.0);
}

TEST(Localise, FindsTheCycleAndTheRecord) {
  const auto all = shares_of([](double t, double strain, int record) { return record == 1 && t > 10.0 && strain < -1e-6; });
  EXPECT_EQ(largest(all, "cycle").bin, "2");
  EXPECT_GT(largest(all, "cycle").share, 0.9);
  EXPECT_EQ(largest(all, "trial").bin, "b.csv");
  EXPECT_GT(largest(all, "trial").share, 0.9);
}

TEST(Localise, FindsThePhaseAndTheRate) {
  const auto hold = shares_of([](double t, double, int) { return std::fmod(t, 10.0) > 3.3 && std::fmod(t, 10.0) < 5.7; });
  EXPECT_EQ(largest(hold, "phase").bin, "hold");
  EXPECT_EQ(largest(hold, "rate").bin.substr(0, 6), "below ");
  const auto load = shares_of([](double t, double, int) { return std::fmod(t, 10.0) < 2.7; });
  EXPECT_EQ(largest(load, "phase").bin, "load");
  EXPECT_EQ(largest(load, "rate").bin.substr(0, 11), "faster than");
}

TEST(Localise, FindsTheBandOfALine) {
  EXPECT_EQ(largest(shares_of([](double, double, int) { return false; }, 1.2), "frequency").bin, "0.5 to 3 Hz");
  EXPECT_EQ(largest(shares_of([](double, double, int) { return false; }, 5.0), "frequency").bin, "3 to 8 Hz");
}

TEST(Localise, NoiseAloneStandsOutNowhere) {
  for (const Share& s : shares_of([](double, double, int) { return false; })) EXPECT_LT(std::abs(s.deviations), 4.0) << s.axis << " " << s.bin;
}

}  // namespace localise_test
}  // namespace filum::reconcile
