#include "reconcile/hardware.h"

#include <gtest/gtest.h>

#include "base/rng.h"
#include "reconcile/result.h"

namespace filum::reconcile {
namespace hardware_test {

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

Dataset rig(Rig r, const std::string& channel, double size) {
  Dataset d;
  d.rig = r;
  d.outputs = {channel};
  d.channels = {{channel, "c", "m", 1.0, 0.0, false, 0.0}};
  Trial t;
  t.file = "a.csv";
  t.time = Eigen::VectorXd::LinSpaced(20, 0.0, 1.0);
  t.specimen = {{"outer_diameter", 1e-3}, {"wall_thickness", 1e-4}};
  t.data["hold_force"] = Eigen::VectorXd::Constant(20, 0.02);
  t.data["wrap_angle"] = Eigen::VectorXd::Constant(20, 3.0);
  t.data[channel] = size * Eigen::VectorXd::LinSpaced(20, 0.9, 1.1);
  d.trials.push_back(t);
  return d;
}

/// Values and sizes as they should be, and a thousand times too large or small, of every rig.
TEST(Hardware, NoticesAUnitThatIsWrongByAThousand) {
  struct Value {
    Rig rig;
    const char* name;
    double usual, nominal;
  };
  for (const Value& v : {Value{Rig::tissue_block, "youngs_modulus", 3e3, 1e3}, {Rig::spatula_press, "youngs_modulus", 6e2, 1e3}, {Rig::vessel_inflation, "youngs_modulus", 2e5, 3e5},
                         {Rig::suture_cantilever, "youngs_modulus", 1.2e9, 2.5e9}, {Rig::suture_pull, "friction_coefficient", 0.35, 0.2}, {Rig::needle_insertion, "stiffness", 80.0, 100.0},
                         {Rig::forceps_bridge, "pressure_gain", 900.0, 667.0}}) {
    Dataset d;
    d.rig = v.rig;
    d.nominal[v.name] = v.nominal;
    for (const double times : {1e-3, 1.0, 1e3}) {
      const auto said = check_units(d, {{v.name, "u", times * v.usual, 0.0, 0.0}});
      ASSERT_EQ(said.size(), times == 1.0 ? 0u : 1u) << v.name << times;
      for (const HardwareCheck& h : said) EXPECT_NE(h.found.find("is the unit of a channel or a size wrong by 1000?"), std::string::npos) << h.found;
    }
  }
  struct Size {
    Rig rig;
    const char* channel;
    double usual;
  };
  for (const Size& v : {Size{Rig::vessel_inflation, "outer_diameter", 1.1e-3}, {Rig::suture_pull, "speed", 1e-3}, {Rig::needle_insertion, "speed", 1.5e-3}, {Rig::tip_hold, "x", 3e-4}, {Rig::forceps_bridge, "angle", 0.4}, {Rig::suture_pull, "pull_force", 0.04}})
    for (const double times : {1e-3, 1.0, 1e3}) EXPECT_EQ(check_units(rig(v.rig, v.channel, times * v.usual), {}).size(), times == 1.0 ? 0u : 1u) << v.channel << times;
}

TEST(Hardware, NoticesATimeThatIsWrongByAThousand) {
  struct Input {
    Rig rig;
    const char *channel, *rate;
    double speed;
  };
  for (const Input& v : {Input{Rig::tissue_block, "displacement", "2 mm/s", 2e-3}, {Rig::spatula_press, "depth", "0.5 mm/s", 5e-4}, {Rig::vessel_inflation, "pressure", "800 Pa/s", 800.0}, {Rig::tissue_block, "displacement", "0.1 1/s", 2e-3}})
    for (const double times : {1e-3, 1.0, 1e3}) {
      Dataset d;
      d.rig = v.rig;
      Trial t;
      t.file = "a.csv";
      t.clocked = true;
      t.protocol["rate"] = v.rate;
      t.time = Eigen::VectorXd::LinSpaced(200, 0.0, 10.0 * times);
      t.data[v.channel] = (v.speed / times * t.time.array()).min(5.0 * v.speed);  // up, then held
      if (v.rig == Rig::vessel_inflation) t.data["outer_diameter"] = Eigen::VectorXd::Constant(200, 1e-3), t.specimen["outer_diameter"] = 1e-3;
      d.trials = {t};
      const auto said = check_units(d, {});
      const bool wrong = times != 1.0 && std::string(v.rate) != "0.1 1/s";
      ASSERT_EQ(said.size(), wrong ? 1u : 0u) << v.rate << times;
      for (const HardwareCheck& h : said) EXPECT_NE(h.found.find("is the unit of time, or of the input, wrong by 1000?"), std::string::npos) << h.found;
    }
}

/// A clock against what the protocol holds, what the needle's speed makes of its way, and what a hand can be seen by.
TEST(Hardware, NoticesAClockThatIsWrongByAThousand) {
  const auto said = [](Rig r, double times, const std::function<void(Trial&)>& fill) {
    Dataset d;
    d.rig = r;
    Trial t;
    t.file = "a.csv";
    t.time = Eigen::VectorXd::LinSpaced(200, 0.0, 10.0 * times);
    fill(t);
    d.trials = {t};
    return check_units(d, {});
  };
  for (const double times : {1e-3, 1.0, 1e3}) {
    const std::size_t many = times == 1.0 ? 0u : 1u;
    const auto held = said(Rig::suture_cantilever, times, [](Trial& t) { t.protocol["hold"] = "4 s"; });
    ASSERT_EQ(held.size(), many) << times;
    const auto needle = said(Rig::needle_insertion, times, [](Trial& t) { t.data["depth"] = Eigen::VectorXd::LinSpaced(200, 0.0, 0.01), t.data["speed"] = Eigen::VectorXd::Constant(200, 1e-3); });
    ASSERT_EQ(needle.size(), many) << times;
    const auto pull = said(Rig::suture_pull, times, [](Trial&) {});
    ASSERT_EQ(pull.size(), many) << times;
    const auto thread = said(Rig::suture_cantilever, times, [](Trial&) {});
    ASSERT_EQ(thread.size(), times < 1.0 ? 1u : 0u) << times;
    const auto hand = said(Rig::tip_hold, times, [](Trial&) {});
    ASSERT_EQ(hand.size(), many) << times;
    if (many == 0) continue;
    EXPECT_NE(held[0].found.find("its protocol holds for 4 s: is the unit of time wrong by 1000?"), std::string::npos) << held[0].found;
    EXPECT_NE(needle[0].found.find("is the unit of time, depth or speed wrong by 1000?"), std::string::npos) << needle[0].found;
    EXPECT_NE(pull[0].found.find("the record lasts"), std::string::npos) << pull[0].found;
    EXPECT_NE(hand[0].found.find("samples a second, expected 4 to 4000"), std::string::npos) << hand[0].found;
  }
}

TEST(Hardware, SaysSizesInTheChannelsOwnUnit) {
  Dataset d = rig(Rig::tip_hold, "x", 0.3);
  d.channels[0].unit = "mm", d.channels[0].scale = 1e-3;
  EXPECT_EQ(check_units(d, {}).at(0).found, "wanders by 60 mm, expected 0.001 to 20: is the unit wrong by 1000?");
}

}  // namespace hardware_test
}  // namespace filum::reconcile
