#include "training/pressure.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "base/error.h"

namespace filum {
namespace pressure_test {

std::string shipped_text() {
  std::ifstream in(std::string(FILUM_SOURCE_DIR) + "/models/brain/pressure-limits.yaml");
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

PressureLimits shipped() { return parse_pressure_limits(YamlNode::parse(shipped_text(), "limits")); }

PressureWatch after(double mmhg, double minutes, PressureLimits limits = shipped()) {
  PressureWatch w(std::move(limits), 60.0);  // a second of the scene is a minute
  for (double t = 0.0; t < minutes; t += 0.01) w.observe(mmhg * kMmHg, 0.01);
  return w;
}

TEST(Pressure, DoseAndRiskAreThoseOfTheAnimals) {
  EXPECT_NEAR(after(20, 15).dose() / (kMmHg * 60), 150.0, 0.2);
  EXPECT_NEAR(after(20, 15).risk(), 0.167, 0.003);  // 1 of 6
  EXPECT_NEAR(after(30, 15).risk(), 0.83, 0.01);    // 5 of 6
  EXPECT_NEAR(after(40, 15).risk(), 0.99, 0.01);    // 6 of 6
  EXPECT_NEAR(after(10, 30).risk(), 0.008, 0.001);
}

TEST(Pressure, DoseRecoversInAPauseUnlessSwitchedOff) {
  PressureWatch w = after(30, 5);
  const double start = w.dose();
  for (double t = 0.0; t < 5.0; t += 0.01) w.observe(0.0, 0.01);
  EXPECT_NEAR(w.dose() / start, std::exp(-5.0 / 3.0), 0.005);  // five minutes off clear 81 %
  EXPECT_EQ(w.releases(), 1);
  PressureLimits assessment = shipped();
  assessment.recovery = false;
  PressureWatch strict = after(30, 5, assessment);
  for (int k = 0; k < 500; ++k) strict.observe(0.0, 0.01);
  EXPECT_NEAR(strict.dose(), start, 1e-6 * start);
}

TEST(Pressure, BandsWaitAndComeBackLaterThanTheyWent) {
  PressureWatch w(shipped(), 1.0);
  const auto hold = [&](double mmhg, double seconds) {
    for (double t = 0.0; t < seconds; t += 0.01) w.observe(mmhg * kMmHg, 0.01);
    return w.band();
  };
  EXPECT_EQ(hold(25, 0.3), PressureBand::green);   // not yet
  EXPECT_EQ(hold(5, 0.1), PressureBand::green);
  EXPECT_EQ(hold(25, 0.4), PressureBand::green);   // the wait begins anew
  EXPECT_EQ(hold(25, 0.3), PressureBand::orange);
  EXPECT_EQ(hold(19, 2.0), PressureBand::orange);  // within the hysteresis
  EXPECT_EQ(hold(17.5, 1.0), PressureBand::yellow);
  EXPECT_EQ(hold(31, 1.0), PressureBand::red);
  EXPECT_EQ(hold(0, 1.0), PressureBand::green);
}

TEST(Pressure, FlutterAboutAThresholdChangesTheBandOnce) {
  PressureWatch w(shipped(), 1.0);
  int changes = 0;
  PressureBand before = w.band();
  for (int k = 0; k < 2000; ++k) {
    w.observe((20.0 + 1.5 * std::sin(0.02 * k)) * kMmHg, 0.01);
    changes += w.band() != before ? 1 : 0;
    before = w.band();
  }
  EXPECT_LE(changes, 2);  // to yellow or orange, then orange for good
  EXPECT_EQ(w.band(), PressureBand::orange);
}

TEST(Pressure, TimersAndAlarmAreSaid) {
  const auto codes = [](const PressureWatch& w) {
    std::vector<std::string> list;
    for (const auto& m : w.messages()) list.push_back(m[1]);
    return list;
  };
  const auto said = [&](const PressureWatch& w, const std::string& code) {
    const auto list = codes(w);
    return std::find(list.begin(), list.end(), code) != list.end();
  };
  EXPECT_FALSE(said(after(8, 4), "release-reminder"));
  EXPECT_TRUE(said(after(8, 5.5), "release-reminder"));
  EXPECT_TRUE(said(after(45, 1), "pressure-alarm"));
  EXPECT_TRUE(said(after(30, 13), "dose-red"));
}

TEST(Pressure, PerfusionModeLatchesInjury) {
  PressureLimits limits = shipped();
  limits.perfusion = true;
  limits.arterial = 50.0 * kMmHg;
  EXPECT_FALSE(after(42, 5, limits).injured());
  PressureWatch w = after(42, 6.5, limits);
  EXPECT_TRUE(w.injured());
  for (int k = 0; k < 500; ++k) w.observe(0.0, 0.01);
  EXPECT_TRUE(w.injured());
  EXPECT_FALSE(after(42, 6.5).injured());  // off
}

TEST(Pressure, NumbersThatAreNotFiniteAreIgnored) {
  PressureWatch w = after(20, 1);
  const double dose = w.dose();
  w.observe(std::nan(""), 0.01);
  EXPECT_EQ(w.dose(), dose);
}

TEST(Pressure, LimitsOutOfOrderAreRefused) {
  const auto refused = [](const std::string& from, const std::string& to) {
    std::string text = shipped_text();
    text.replace(text.find(from), from.size(), to);
    try {
      parse_pressure_limits(YamlNode::parse(text, "limits"));
    } catch (const InputError& e) {
      return e.field;
    }
    return std::string();
  };
  EXPECT_NE(refused("orange: \"20 mmHg\"", "orange: \"5 mmHg\""), "");
  EXPECT_NE(refused("yellow: \"10 mmHg\"", "yellow: \"10 mm\""), "");
  EXPECT_NE(refused("hysteresis", "hystersis"), "");
}

}  // namespace pressure_test
}  // namespace filum
