// What is held out: whole protocols, the fastest rate and another size on purpose; and that a name must stand beside the instruments.

#include "reconcile/challenge.h"

#include <gtest/gtest.h>

#include "base/rng.h"
#include "records.h"
#include "searched.h"
#include "reconcile/choose.h"
#include "reconcile/rivals.h"

namespace filum::reconcile {
namespace challenge_test {

/// Two rates, the faster one twice, and two records of a flatter block; `more` goes to the last trial.
std::string trials(const std::string& more = "") {
  return "  - { file: a.csv, protocol: { mode: compression, rate: \"1 mm/s\" } }\n  - { file: b.csv, protocol: { mode: compression, rate: \"2 mm/s\" } }\n"
         "  - { file: c.csv, protocol: { mode: compression, rate: \"8 mm/s\" } }\n  - { file: d.csv, protocol: { mode: compression, rate: \"8 mm/s\" } }\n"
         "  - { file: e.csv, protocol: { mode: compression, rate: \"1 mm/s\" }, specimen: { height: \"4 mm\" }" + more + " }\n";
}

const std::vector<std::pair<std::string, double>> kSpeeds = {{"a.csv", 1}, {"b.csv", 2}, {"c.csv", 8}, {"d.csv", 8}, {"e.csv", 1}};

/// A block of 1 kPa that relaxes by a share g within 2 s, read by a sensor that drifts [mN/s].
Dataset block(const Folder& f, const std::string& list, double g, double drift, double noise = 0.03) {
  Rng rng(3);
  f.write("experiment.yaml", block_yaml(list));
  for (const auto& [name, speed] : kSpeeds) {
    double q = 0, last_t = 0, last_f = 0;
    const double stiffness = name == "e.csv" ? 6.25 : 5.0;
    f.write(name, block_csv([&](double t, double u, int i) {
              const double force = stiffness * u, dt = t - last_t;
              if (i > 0) q = (q * (1 - 0.25 * dt) + 0.25 * dt * (force + last_f)) / (1 + 0.25 * dt);
              last_t = t, last_f = force;
              return force - g * q + drift * t + noise * rng.normal();
            }, speed));
  }
  return load_dataset(f.path(), FILUM_SOURCE_DIR);
}

std::vector<std::string> held(const Dataset& d, const Part& p) {
  std::vector<std::string> out;
  for (std::size_t i = 0; i < p.trials.size(); ++i)
    if (p.trials[i]) out.push_back(d.trials[i].file);
  return out;
}

TEST(Challenge, TheFastestRateAndAnotherSizeAreHeldOutOnPurpose) {
  Folder f;
  const Dataset d = block(f, trials(), 0.0, 0.0);
  const double slow = rate_of(d, d.trials[0]);
  EXPECT_NEAR(slow, 0.5e-3 / 6.0, 0.05 * 0.5e-3 / 6.0);  // 0.5 mm in 0.3 of 20 s
  EXPECT_NEAR(rate_of(d, d.trials[2]) / slow, 8.0, 0.1);
  const auto parts = parts_of(d, {});
  ASSERT_EQ(parts.size(), 4u);
  EXPECT_EQ(parts[0].held, "the fastest rate");
  EXPECT_EQ(held(d, parts[0]), (std::vector<std::string>{"c.csv", "d.csv"}));
  EXPECT_EQ(parts[1].held, "another size");
  EXPECT_EQ(held(d, parts[1]), (std::vector<std::string>{"e.csv"}));
  for (std::size_t i = 2; i < 4; ++i) EXPECT_EQ(held(d, parts[i]).size(), 1u);  // of the rest each protocol in turn: a, b
  for (const Part& p : parts) EXPECT_TRUE(p.counts);
}

TEST(Challenge, TrialsThatAreMarkedAloneDecide) {
  Folder f;
  const Dataset d = block(f, trials(", hold_out: true"), 0.0, 0.0);
  const auto parts = parts_of(d, {});
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_EQ(held(d, parts[0]), (std::vector<std::string>{"e.csv"}));
  EXPECT_TRUE(parts[0].counts);
  EXPECT_EQ(parts[1].held, "the fastest rate");  // told, since it can be: but it does not count
  EXPECT_FALSE(parts[1].counts);
}

TEST(Challenge, OneRateAndOneSizeLeaveTheProtocolsInTurn) {
  Folder f;
  std::string list = trials();
  list.resize(list.find("  - { file: c.csv"));
  list.replace(list.find("2 mm/s"), 1, "1");
  Dataset d = block(f, list, 0.0, 0.0);
  d.trials[1].time *= 2.0;  // b.csv went twice as fast
  const auto parts = parts_of(d, {});
  ASSERT_EQ(parts.size(), 2u);  // one protocol: each replicate in turn
  for (const Part& p : parts) EXPECT_EQ(p.held, "a protocol");
}

TEST(Challenge, EveryFoldTellsItsGapBeforeAndAfter) {
  Folder f;
  const Dataset d = block(f, trials(), 0.4, 0.0);
  const Result r = reconcile(d);
  ASSERT_EQ(r.decide.verdict, "effect") << r.decide.sentence;
  ASSERT_EQ(r.challenge.folds.size(), 4u);
  EXPECT_EQ(r.challenge.folds[0].trials, (std::vector<std::string>{"c.csv", "d.csv"}));
  for (const Fold& fold : r.challenge.folds) {
    EXPECT_GT(fold.gap.before, 1.5) << fold.held;
    EXPECT_NEAR(fold.gap.after, 1.0, 0.2) << fold.held;
  }
}

/// A sensor that drifts, and relaxation in its place: neither beside the drift nor on held-out records does it do better.
TEST(Challenge, InstrumentsComeFirst) {
  Options options;
  const ChallengeOptions rules;
  {
    Folder f;
    const Dataset d = block(f, trials(), 0.0, 0.02);
    const auto model = make_model(d);
    const auto forms = model->all_forms();
    const Candidates sets = searched(*model, forms, options);
    const auto relaxation = std::find_if(sets.fitted().begin(), sets.fitted().end(), [](const Fit& c) { return effects_in(c) == std::vector<Effect>{Effect::viscoelastic_relaxation}; });
    ASSERT_NE(relaxation, sets.fitted().end());
    const auto first = instruments_not_outdone(sets, *relaxation, challenge(sets, &*relaxation, rules, options), rules, options);
    ASSERT_FALSE(first.empty());
    EXPECT_EQ(effects_in(*first[0]), std::vector<Effect>{Effect::sensor_drift});
  }
  Folder f;
  const Dataset d = block(f, trials(), 0.2, 0.01);
  options.rules.compare.explained = 0.0;  // whatever an instrument explains
  const auto model = make_model(d);
  const auto forms = model->all_forms();
  const Candidates sets = searched(*model, forms, options);
  ASSERT_EQ(effects_in(*sets.best(1)), std::vector<Effect>{Effect::viscoelastic_relaxation});
  EXPECT_TRUE(instruments_not_outdone(sets, *sets.best(1), challenge(sets, sets.best(1), rules, options), rules, options).empty());
}

/// Stiffening so strong that the sensor's drift promises less than a fifth of it: instruments are fitted all the same.
TEST(Challenge, InstrumentsAreFittedHoweverFarTheBestIsAhead) {
  Folder f;
  Rng rng(5);
  f.write("experiment.yaml", block_yaml(trials()));
  for (const auto& [name, speed] : kSpeeds) {
    const double height = name == "e.csv" ? 4.0 : 5.0;
    f.write(name, block_csv([&](double t, double u, int) { return 25.0 * (u / height) * (1.0 + 60.0 * u * u / height / height) - 0.01 * t + 0.03 * rng.normal(); }, speed));
  }
  const Result r = reconcile(load_dataset(f.path(), FILUM_SOURCE_DIR));
  double best = 0.0;
  for (const Screened& s : r.screen.effects) best = std::max(best, std::isfinite(s.gain) ? s.gain : 0.0);
  int behind = 0;
  for (const Screened& s : r.screen.effects)
    if (info(s.effect).stage == 0 && s.gain >= 100.0) {  // many times what is asked, whatever the first estimate of the noise was
      EXPECT_EQ(s.what, "fitted") << info(s.effect).name << " " << s.gain << " of " << best;
      behind += s.gain < r.rules.screen.share * best ? 1 : 0;
    }
  EXPECT_GE(behind, 1);
}

}  // namespace challenge_test
}  // namespace filum::reconcile
