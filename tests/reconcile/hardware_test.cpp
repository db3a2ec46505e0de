#include "reconcile/hardware.h"

#include <gtest/gtest.h>

#include "base/rng.h"

namespace filum::reconcile {
namespace {

/// A record of 400 samples, changed by `spoil`; what the checks say of it.
std::vector<std::string> checks(const std::function<void(Eigen::VectorXd& t, Eigen::VectorXd& y)>& spoil) {
  Dataset d;
  d.rig = Rig::tissue_block;
  d.outputs = {"force"};
  d.channels = {{"force", "F", "N", 1.0, 0.0, false, 0.0}};
  Trial t;
  t.file = "a.csv";
  t.time = Eigen::VectorXd::LinSpaced(400, 0.0, 40.0);
  Eigen::VectorXd y(400);
  Rng rng(1);
  for (int i = 0; i < 400; ++i) y[i] = std::sin(0.1 * i) + 0.01 * rng.normal();
  spoil(t.time, y);
  t.data["force"] = y;
  d.trials.push_back(t);
  std::vector<std::string> out;
  for (const HardwareCheck& h : check_hardware(d)) out.push_back(h.what);
  return out;
}

using Names = std::vector<std::string>;

TEST(Hardware, SaysNothingOfAGoodRecord) { EXPECT_EQ(checks([](auto&, auto&) {}), Names()); }

TEST(Hardware, FindsAGapOfTheClock) {
  EXPECT_EQ(checks([](auto& t, auto&) { t.tail(200).array() += 3.0; }), Names{"gap"});
}

TEST(Hardware, FindsAClockThatStrays) {
  Rng rng(2);
  EXPECT_EQ(checks([&](auto& t, auto&) { for (auto& v : t) v += 0.01 * rng.uniform(); }), Names{"clock"});
}

TEST(Hardware, FindsStepsOfTheConverter) {
  EXPECT_EQ(checks([](auto&, auto& y) { y = (y.array() / 0.002).round().matrix() * 0.002; }), Names{"quantisation"});
}

TEST(Hardware, FindsClippedTops) {
  EXPECT_EQ(checks([](auto&, auto& y) { y = y.array().min(0.8).matrix(); }), Names{"saturation"});
}

TEST(Hardware, FindsFrozenSamples) {
  EXPECT_EQ(checks([](auto&, auto& y) { y.segment(100, 20).setConstant(y[100]); }), Names{"frozen"});
}

}  // namespace
}  // namespace filum::reconcile
