// The experiment that is proposed where rivals tie, tried: a forceps moved at one speed cannot tell play from lag; at the speed proposed it can.

#include <gtest/gtest.h>

#include "base/rng.h"
#include "records.h"
#include "reconcile/report.h"

namespace filum::reconcile {
namespace next_experiment_test {

constexpr double kLag = 0.4;  // [s], first order

/// Three sweeps of 0 to 28 degrees in `span` seconds, ten samples a second.
std::string record(double span, double noise, Rng& rng) {
  std::ostringstream s;
  s << "t,a,g,n\n";
  double y = 0.0;
  const int fine = 50, n = static_cast<int>(10 * span);
  for (int i = 0; i <= n * fine; ++i) {
    const double t = span * i / (n * fine), a = 28.0 * (1.0 - std::abs(std::fmod(3.0 * t / span, 2.0) - 1.0)), h = span / (n * fine);
    y = i == 0 ? a : y + h / kLag * (a - y);
    if (i % fine == 0) s << t << "," << a << "," << 1.0 + std::sin(0.9 * t) << "," << std::round(600.0 + 120.0 * y + noise * rng.normal()) << "\n";
  }
  return s.str();
}

void write(const Folder& f, double noise, double further = 0.0) {
  Rng rng(3);
  std::string trials;
  for (const char* name : {"a", "b", "c"}) {
    f.write(std::string(name) + ".csv", record(60.0, noise, rng));
    trials += std::string("  - { file: ") + name + ".csv, protocol: { direction: closing }, repeat: A }\n";
  }
  if (further > 0.0) {
    f.write("further.csv", record(further, noise, rng));
    trials += "  - { file: further.csv, protocol: { direction: closing }, repeat: B }\n";
  }
  f.write("experiment.yaml", "format: filum-experiment/1\ntitle: forceps\nsource: test\nrig: forceps-bridge\nspecimen: { bits: 14, reference: \"3.3 V\" }\n"
          "model: { file: forceps/linear, free: [strain_gain, strain_offset] }\nchannels:\n  - { name: time, column: t, unit: s }\n"
          "  - { name: angle, column: a, unit: deg, kind: input }\n  - { name: grip_force, column: g, unit: N, kind: input }\n  - { name: strain_counts, column: n, unit: count, kind: output }\ntrials:\n" + trials);
}

Result solve(const Folder& f) { return reconcile(load_dataset(f.path(), FILUM_SOURCE_DIR)); }

TEST(NextExperiment, WhatItProposesTellsTheRivalsApart) {
  Folder f;
  write(f, 150.0);
  const Result before = solve(f);
  ASSERT_EQ(before.decide.verdict, "ambiguous") << before.decide.sentence;
  ASSERT_TRUE(before.next.has_value());
  const bool slower = before.next->protocol == "the first trial ten times slower", faster = before.next->protocol == "the first trial ten times faster";
  ASSERT_TRUE(slower || faster) << before.next->protocol;
  EXPECT_GE(before.next->chance, 0.8);
  EXPECT_NE(before.decide.sentence.find("What would: "), std::string::npos);
  Folder g;
  write(g, 150.0, slower ? 600.0 : 6.0);
  const Result after = solve(g);
  ASSERT_EQ(after.decide.verdict, "effect") << after.decide.sentence;
  ASSERT_EQ(after.decide.effects.size(), 1u);
  EXPECT_EQ(after.decide.effects[0].effect, Effect::sensor_lag);
}

}  // namespace next_experiment_test
}  // namespace filum::reconcile
