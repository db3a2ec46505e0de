// A still hand: what tremor, hum and pulse put into a record comes back with its size, and breath is not taken for hum folded by the sampling.

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <numbers>

#include "base/rng.h"
#include "records.h"
#include "reconcile/report.h"

namespace filum::reconcile {
namespace hold_test {

using Signal = std::function<std::function<double(double)>(Rng&)>;

/// What becomes of a sample [um] of the last record, which is held out then.
using Altered = std::function<double(double)>;

/// Four records of 25 s in um with 4 um of white noise; `signal` gives what is added to (time, random). Samples end at `floor`.
Result held(double rate, std::uint64_t seed, const Signal& signal, const Altered& altered = {}, double floor = -1e9, const Options& options = {}) {
  Folder f;
  std::string trials;
  Rng rng(seed);
  for (const char* name : {"a.csv", "b.csv", "c.csv", "d.csv"}) {
    const bool out = altered && std::string(name) == "d.csv";
    trials += std::string("  - { file: ") + name + ", protocol: { support: free }" + (out ? ", hold_out: true" : "") + " }\n";
    const auto add = signal(rng);
    std::ostringstream s;
    s << "t,x\n";
    for (int i = 0; i < static_cast<int>(25.0 * rate); ++i) {
      const double t = i / rate, u = t / 25.0;
      const double x = std::max(floor, 40.0 * u - 25.0 * u * u * u + 4.0 * rng.normal() + add(t));
      s << t << "," << (out ? altered(x) : x) << "\n";
    }
    f.write(name, s.str());
  }
  f.write("experiment.yaml", "format: filum-experiment/1\ntitle: hand\nsource: test\nrig: tip-hold\nspecimen: { sensor: optical }\nmodel:\n  file: hand/still\n  free: []\n"
                             "channels:\n  - { name: time, column: t, unit: s }\n  - { name: x, column: x, unit: um, kind: output, noise: \"4 um\" }\ntrials:\n" + trials);
  return reconcile(load_dataset(f.path(), FILUM_SOURCE_DIR), options);
}

const Estimate& value(const Result& r, const std::string& name) {
  for (const Estimate& e : r.decide.effects.at(0).parameters)
    if (e.name == name) return e;
  throw std::runtime_error(name);
}

std::function<double(double)> sine(Rng& rng, double frequency, double amplitude) {
  const double phase = 2.0 * std::numbers::pi * rng.uniform();
  return [=](double t) { return amplitude * std::sin(2.0 * std::numbers::pi * frequency * t + phase); };
}

/// A resonance of 9.5 Hz, damping 0.05, kicked by noise: its skirts hold a tenth of its power beyond +-2 Hz.
TEST(Hold, TremorHasAllItsPower) {
  const Result r = held(100.0, 3, [](Rng& rng) {
    double s = 0.0, ds = 0.0, square = 0.0;
    std::vector<double> record;
    for (int i = 0; i < 20 * 2500; ++i) {
      const double h = 5e-4, w = 2.0 * std::numbers::pi * 9.5;
      ds += h * (-w * w * s - 0.1 * w * ds) + std::sqrt(h) * rng.normal();
      s += h * ds;
      if (i % 20 == 0) record.push_back(s), square += s * s;
    }
    const double scale = 12.0 / std::sqrt(square / static_cast<double>(record.size()));
    return [record, scale](double t) { return scale * record.at(static_cast<std::size_t>(std::lround(100.0 * t))); };
  });
  ASSERT_EQ(r.decide.verdict, "effect") << r.decide.sentence;
  EXPECT_EQ(r.decide.effects[0].effect, Effect::physiological_tremor);
  EXPECT_NEAR(value(r, "frequency").value, 9.5, 0.3);
  EXPECT_NEAR(value(r, "rms").value / 12e-6, 1.0, 0.03);
  // it shakes alike in all four records: each holds its own part
  ASSERT_EQ(r.localise.cells.size(), 4u);
  double sum = 0.0;
  for (const Cell& c : r.localise.cells) {
    EXPECT_NEAR(c.share, 0.25, 0.1) << c.trial;
    sum += c.share;
  }
  EXPECT_NEAR(sum, 1.0, 1e-9);
  EXPECT_NE(r.localise.cells[0].trial, r.localise.cells[1].trial);
}

/// Power at 4 Hz that no effect of the catalogue makes, in one record of four: there it is said to be, and resampled records do not all show it.
TEST(Hold, UnnamedPowerIsFoundInTheRecordThatHasIt) {
  int record = 0;
  const Result r = held(100.0, 5, [&record](Rng& rng) {
    std::vector<double> path;
    double s = 0.0, ds = 0.0;
    for (int i = 0; i < 20 * 2500; ++i) {
      const double h = 5e-4, w = 2.0 * std::numbers::pi * 4.0;
      ds += h * (-w * w * s - 0.4 * w * ds) + std::sqrt(h) * rng.normal();
      s += h * ds;
      if (i % 20 == 0) path.push_back(s);
    }
    const double scale = record++ == 1 ? 1350.0 : 0.0;
    return [path, scale](double t) { return scale * path.at(static_cast<std::size_t>(std::lround(100.0 * t))); };
  });
  ASSERT_EQ(r.decide.verdict, "unknown") << r.decide.sentence;
  ASSERT_FALSE(r.localise.cells.empty());
  EXPECT_GT(r.localise.cells[0].share, 0.9);
  ASSERT_EQ(r.describe.shape.size(), 1u);
  EXPECT_GT(r.describe.shape[0].stability, 0.4);
  EXPECT_LT(r.describe.shape[0].stability, 1.0);
}

/// Between the frequencies of a grid of 0.3 cycles a record a sine would lose 1 - sin(x)/x.
TEST(Hold, APulseHasItsAmplitude) {
  for (const double f : {1.2, 1.206}) {
    const Result r = held(100.0, 4, [f](Rng& rng) { return sine(rng, f, 10.0); });
    ASSERT_EQ(r.decide.verdict, "effect") << r.decide.sentence;
    EXPECT_EQ(r.decide.effects[0].effect, Effect::pulsation);
    EXPECT_NEAR(value(r, "amplitude").value / 10e-6, 1.0, 0.015);
    EXPECT_NEAR(value(r, "frequency").value, f, 0.001);
  }
}

/// Sampled 60 times a second 60.05 Hz goes round 1.25 times in a record, of which the slow drift takes a part.
TEST(Hold, HumFoldedToACycleOfTheRecordHasItsAmplitude) {
  const Result r = held(60.0, 5, [](Rng& rng) { return sine(rng, 60.05, 12.0); });
  ASSERT_EQ(r.decide.verdict, "effect") << r.decide.sentence;
  EXPECT_EQ(r.decide.effects[0].effect, Effect::mains_hum);
  const Estimate& a = value(r, "amplitude");
  EXPECT_NEAR(a.value / 12e-6, 1.0, 0.06);
  EXPECT_LT(a.low, 12e-6);
  EXPECT_GT(a.high, 12e-6);
}

TEST(Hold, BreathIsNotHumFoldedByTheSampling) {
  const Result r = held(60.0, 6, [](Rng& rng) {
    const auto heart = sine(rng, 1.56, 11.0), breath = sine(rng, 0.235, 8.0);
    return [=](double t) { return heart(t) + breath(t); };
  });
  ASSERT_EQ(r.decide.verdict, "effect") << r.decide.sentence;
  ASSERT_EQ(r.decide.effects.size(), 1u);
  EXPECT_EQ(r.decide.effects[0].effect, Effect::pulsation);
}

TEST(Hold, RecordsThatAreHeldOutChooseAndFitNothing) {
  const Signal hum = [](Rng& rng) { return sine(rng, 50.0, 9.0); };
  const Result r = held(130.0, 5, hum, [](double x) { return x; }), other = held(130.0, 5, hum, [](double x) { return std::clamp(1.7 * x, -12.0, 12.0); });
  ASSERT_EQ(r.decide.verdict, "effect") << r.decide.sentence;
  ASSERT_EQ(r.decide.effects.size(), 1u);
  ASSERT_EQ(other.decide.effects.size(), 1u) << "clipped where nobody may look";
  EXPECT_EQ(r.decide.sentence, other.decide.sentence);
  EXPECT_EQ(value(r, "amplitude").value, value(other, "amplitude").value);
  EXPECT_EQ(value(r, "amplitude").high, value(other, "amplitude").high);
  EXPECT_EQ(r.fit.noise.output[0].sigma, other.fit.noise.output[0].sigma);
  EXPECT_EQ(r.decide.gap.after, other.decide.gap.after);
  EXPECT_NE(r.challenge.gap.after, other.challenge.gap.after);
}

const Screened& screened_of(const Result& r, Effect effect) {
  for (const Screened& s : r.screen.effects)
    if (s.effect == effect) return s;
  throw std::runtime_error("not screened");
}

/// A still hand's residual is one of those that noise makes; a hum of two thirds of the noise is not, and every effect of the rig has its line.
TEST(Hold, DetectionIsByRepetitionsOfAStillHand) {
  const Signal still = [](Rng&) { return [](double) { return 0.0; }; };
  int low = 0, middling = 0;
  for (const std::uint64_t seed : {11, 12, 13, 14, 15, 16}) {
    const Result r = held(100.0, seed, still);
    ASSERT_TRUE(r.detect.has_value());
    EXPECT_EQ(r.decide.verdict, "agree");
    EXPECT_EQ(r.detect->repetitions, 500);
    EXPECT_TRUE(std::is_sorted(r.detect->null_scores.begin(), r.detect->null_scores.end()));
    low += r.detect->p < 0.05 ? 1 : 0;
    middling += r.detect->p < 0.9 ? 1 : 0;
    EXPECT_EQ(r.screen.effects.size(), effects_of(Rig::tip_hold).size());
    for (const Screened& s : r.screen.effects) EXPECT_EQ(s.what.rfind("not fitted", 0) == 0, s.effect != Effect::sensor_lag && s.effect != Effect::sensor_drift) << info(s.effect).name << ": " << s.what;
  }
  EXPECT_LE(low, 1);
  EXPECT_GE(middling, 2);
  const Result r = held(130.0, 5, [](Rng& rng) { return sine(rng, 50.0, 2.7); });
  EXPECT_LE(r.detect->p, 2.0 / 501.0 + 1e-12);
  EXPECT_GT(r.detect->score, r.detect->null_scores.back());
  EXPECT_EQ(screened_of(r, Effect::mains_hum).what, "fitted");
  EXPECT_GT(screened_of(r, Effect::mains_hum).gain, 50.0);
  EXPECT_EQ(screened_of(r, Effect::sensor_lag).what.rfind("these trials could not show it: ", 0), 0u);
}

/// The place of a beat is learnt in one half of the records and explains the other; of one that stops it does not.
TEST(Hold, WithoutRecordsHeldOutHalvesJudgeEachOther) {
  const Result whole = held(100.0, 7, [](Rng& rng) { return sine(rng, 1.2, 10.0); });
  ASSERT_EQ(whole.decide.verdict, "effect");
  EXPECT_NE(whole.challenge.how.find("taken from one half of every record and judged in the other"), std::string::npos) << whole.challenge.how;
  EXPECT_NE(whole.challenge.gap.before, whole.decide.gap.before);
  EXPECT_GT(whole.challenge.gap.before, 1.8);
  EXPECT_LT(whole.challenge.gap.after, 1.1);
  // a beat that stops: the second half puts it anywhere, and so explains nothing of the first
  const Result stops = held(100.0, 7, [](Rng& rng) {
    const auto beat = sine(rng, 1.2, 10.0);
    return [=](double t) { return t < 12.5 ? beat(t) : 0.0; };
  });
  ASSERT_EQ(stops.decide.verdict, "effect") << stops.decide.sentence;
  EXPECT_LT(stops.decide.gap.after, 1.1);
  EXPECT_GT(stops.challenge.gap.after, 1.3);
}

TEST(Hold, WhatIsLeftIsWithoutTheLine) {
  const Result r = held(130.0, 5, [](Rng& rng) { return sine(rng, 50.0, 9.0); });
  ASSERT_EQ(r.decide.verdict, "effect");
  const auto rms = [](const Fit& f) { return std::sqrt(f.residual[0][0].squaredNorm() / static_cast<double>(f.residual[0][0].size())); };
  EXPECT_GT(rms(r.decide.before), 7e-6);
  EXPECT_NEAR(rms(r.decide.after), 4e-6, 0.2e-6);
}

TEST(Hold, AClippedBottomHasItsOwnLimit) {
  const Result r = held(100.0, 9, [](Rng&) { return [](double) { return 0.0; }; }, {}, -2.0);
  ASSERT_EQ(r.decide.verdict, "effect") << r.decide.sentence;
  EXPECT_EQ(r.decide.effects[0].effect, Effect::saturation);
  const Estimate limit = value(r, "limit");
  EXPECT_NEAR(limit.value, -2e-6, 1e-9);
  EXPECT_LT(limit.low, limit.value);
  EXPECT_GT(limit.high, limit.value);
}

TEST(Hold, ProgressIsToldAndItCanBeCancelled) {
  const Signal still = [](Rng&) { return [](double) { return 0.0; }; };
  Options options;
  std::vector<double> shares;
  options.progress = [&](const std::string&, double share) { shares.push_back(share); };
  const Result r = held(100.0, 2, still, {}, -1e9, options);
  EXPECT_GE(shares.size(), 4u);
  EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
  EXPECT_EQ(r.decide.verdict, "agree");
  EXPECT_NE(r.decide.sentence.find("would change this"), std::string::npos) << r.decide.sentence;
  options.cancelled = [] { return true; };
  EXPECT_THROW(held(100.0, 2, still, {}, -1e9, options), Cancelled);
}

}  // namespace hold_test
}  // namespace filum::reconcile
