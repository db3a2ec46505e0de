// Folded lines and the motion's harmonics: where they stand is arithmetic; whether they are in step is the phase of repetitions.

#include <gtest/gtest.h>

#include <numbers>

#include "base/rng.h"
#include "records.h"
#include "reconcile/in_step.h"
#include "reconcile/result.h"

namespace filum::reconcile {
namespace in_step_test {

constexpr double kPi = std::numbers::pi;

/// One and a half sweeps of a forceps in a minute, five samples a second: the motion's period is 40 s.
double angle_at(double t) { return 28.0 * (1.0 - std::abs(std::fmod(3.0 * t / 60.0, 2.0) - 1.0)); }

TEST(InStep, PeriodOfSweepsRampsAndRest) {
  const Eigen::VectorXd t = Eigen::VectorXd::LinSpaced(601, 0.0, 60.0);
  const auto period = [&](auto motion) { return period_of(t, t.unaryExpr(motion)); };
  EXPECT_NEAR(period([](double s) { return angle_at(s); }), 40.0, 0.1);
  EXPECT_NEAR(period([](double s) { return 28.0 - angle_at(s); }), 40.0, 0.1);
  EXPECT_NEAR(period([](double s) { return std::sin(2.0 * kPi * 0.5 * s); }), 2.0, 0.01);
  EXPECT_NEAR(period([](double s) { return std::min(s, 60.0 - s); }), 60.0, 1e-9);  // there and back once
  EXPECT_EQ(period([](double) { return 3.0; }), 0.0);
  // an encoder that trembles as it passes the middle has not turned
  EXPECT_NEAR(period([](double s) { return angle_at(s) + 1.5 * std::cos(40.0 * s); }), 40.0, 1.0);
}

Trial sweep(int samples) {
  Trial t;
  t.time = Eigen::VectorXd::LinSpaced(samples, 0.0, 60.0);
  t.data["angle"] = t.time.unaryExpr([](double s) { return angle_at(s); });
  return t;
}

TEST(InStep, FoldedLinesStandOnHarmonicsOrBetween) {
  Dataset d;
  d.channels = {{"angle", "a", "deg", 1.0, 0.0, true, 0.0}};
  const Trial t = sweep(301);  // 5 Hz
  EXPECT_NEAR(folded(t, 50.1), 0.1, 1e-9);
  EXPECT_NEAR(folded(t, 59.9), 0.1, 1e-9);
  EXPECT_TRUE(on_harmonic(d, t, 50.1, 12));    // 4 times a fortieth
  EXPECT_FALSE(on_harmonic(d, t, 51.0, 12));   // 40 times
  EXPECT_TRUE(on_harmonic(d, t, 51.0, 40));
  Trial many = t;                              // 30 sweeps there and back: between two harmonics there is room
  many.data["angle"] = many.time.unaryExpr([](double s) { return std::sin(2.0 * kPi * 0.5 * s); });
  EXPECT_TRUE(on_harmonic(d, many, 51.0, 12));
  EXPECT_FALSE(on_harmonic(d, many, 51.25, 12));
}

/// Six records of a forceps; `more` in counts from time and record.
Result solve(const std::function<double(double, int)>& more, int seed = 4) {
  Folder f;
  Rng rng(static_cast<std::uint64_t>(seed));
  std::string trials;
  for (int i = 0; i < 6; ++i) {
    std::ostringstream s;
    s << "t,a,g,n,p\n";
    for (int k = 0; k <= 300; ++k) {
      const double t = 0.2 * k, a = i < 3 ? angle_at(t) : 28.0 - angle_at(t);
      s << t << "," << a << ",1," << std::round(600.0 + 120.0 * a + more(t, i) + 20.0 * rng.normal()) << "," << std::round(300.0 + 5.0 * rng.normal()) << "\n";
    }
    const std::string name = std::string(1, static_cast<char>('a' + i)) + ".csv";
    f.write(name, s.str());
    trials += "  - { file: " + name + ", protocol: { direction: " + (i < 3 ? "opening }, repeat: A }\n" : "closing }, repeat: B }\n");
  }
  f.write("experiment.yaml", "format: filum-experiment/1\ntitle: forceps\nsource: test\nrig: forceps-bridge\nspecimen: { bits: 14, reference: \"3.3 V\" }\n"
          "model: { file: forceps/linear, free: [strain_gain, strain_offset, pressure_offset] }\nchannels:\n  - { name: time, column: t, unit: s }\n"
          "  - { name: angle, column: a, unit: deg, kind: input }\n  - { name: grip_force, column: g, unit: N, kind: input }\n  - { name: strain_counts, column: n, unit: count, kind: output }\n  - { name: pressure_counts, column: p, unit: count, kind: output }\ntrials:\n" + trials);
  return reconcile(load_dataset(f.path(), FILUM_SOURCE_DIR));
}

bool fitted(const Result& r, Effect e) {
  return std::any_of(r.decide.tried.begin(), r.decide.tried.end(), [&](const Tried& t) { return std::find(t.effects.begin(), t.effects.end(), e) != t.effects.end(); });
}

/// A ripple of the angle, four to the period, falls where 50.1 Hz is folded to: it is no hum. The same line with a phase of its own in every record is.
TEST(InStep, WhatFollowsTheMotionIsNoHum) {
  const Result ripple = solve([](double t, int i) { return 40.0 * std::cos(2.0 * kPi * (0.1 * t + (i < 3 ? 0.0 : 2.0))); });
  EXPECT_FALSE(fitted(ripple, Effect::mains_hum)) << ripple.decide.sentence;
  const double phase[] = {0.3, 2.5, 4.4, 1.1, 5.3, 3.4};
  const Result hum = solve([&](double t, int i) { return 40.0 * std::cos(2.0 * kPi * 50.1 * t + phase[i]); });
  ASSERT_EQ(hum.decide.verdict, "effect") << hum.decide.sentence;
  EXPECT_EQ(hum.decide.effects[0].effect, Effect::mains_hum);
  // the strain's line, not the mean with a pressure that has none; and a frequency is as sure as the clock, not as a gain
  for (const Estimate& e : hum.decide.effects[0].parameters) {
    const double truth = e.name == "frequency" ? 50.1 : 40.0;
    EXPECT_LE(e.low, truth) << e.name;
    EXPECT_GE(e.high, truth) << e.name;
    EXPECT_LT(truth - e.low, e.name == "frequency" ? 0.03 : 8.0) << e.name;  // upwards an amplitude is open to what a clock that strays would have blurred
  }
}

}  // namespace in_step_test
}  // namespace filum::reconcile
