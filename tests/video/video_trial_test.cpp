// Videos as trials of a dataset: channels against the motion that was rendered, and a creeping thread named from films alone.

#include "reconcile/video_trial.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "rendered.h"
#include "reconcile/full_solver.h"
#include "reconcile/result.h"
#include "tests/reconcile/records.h"

namespace filum::reconcile {
namespace video_trial_test {

constexpr double kScale = 50e-6;  // [m], of a pixel

/// Right half moves by `of(k)`, left half rests.
Origin right_half(const std::function<std::array<double, 2>(int)>& of, double middle) {
  return [=](double x, double y, int k) {
    const auto m = of(k);
    return x < middle ? std::array{x, y} : std::array{x - m[0], y - m[1]};
  };
}

const std::string kThread =
    "format: filum-experiment/1\ntitle: thread\nsource: rendered\nrig: suture-cantilever\nspecimen: { diameter: \"40 um\", density: \"1140 kg/m3\" }\n"
    "model: { file: suture/elastic, free: [youngs_modulus] }\nchannels:\n  - { name: time, column: t, unit: s }\n  - { name: tip_drop, column: d, unit: mm, kind: output }\ntrials:\n";

std::string thread_trial(const std::string& name, const std::string& side) {
  return "  - { file: " + name + ", protocol: { orientation: " + side + ", overhang: \"10 mm\" }, video: { scale: \"50 um\", points: [ { name: clamp, x: 30, y: 40 }, { name: tip, x: 110, y: 50 } ] } }\n";
}

TEST(VideoTrial, TipOfAThreadSinksAsRendered) {
  Folder f;
  const auto sink = [](int k) { return std::array{-0.02 * k, 0.3 * k}; };
  ASSERT_TRUE(render(f.file("a.avi"), 60, 150, 110, 1.5, Waves(1), right_half(sink, 70), 1));
  f.write("experiment.yaml", kThread + thread_trial("a.avi", "down"));
  const Dataset d = load_dataset(f.path(), FILUM_SOURCE_DIR);
  const Eigen::VectorXd& drop = d.trials[0].at("tip_drop");
  ASSERT_EQ(drop.size(), 60);
  for (int k = 0; k < 60; ++k) EXPECT_NEAR(drop[k], kScale * (10.0 + 0.3 * k), 0.1 * kScale) << k;
  EXPECT_GT(d.trials[0].tracked.at("tip_drop"), 0.0);
  EXPECT_LT(d.trials[0].tracked.at("tip_drop"), 0.1 * kScale);
  EXPECT_NEAR(d.trials[0].time[59], 59 / 25.0, 1e-9);
}

TEST(VideoTrial, PlatenOfABlockGivesDisplacementAtTheTimesOfTheTable) {
  Folder f;
  const Origin press = [](double x, double y, int k) { return y < 60 ? std::array{x, y - 0.2 * k} : std::array{x, y}; };  // the platen comes down
  ASSERT_TRUE(render(f.file("a.avi"), 50, 100, 130, 1.0, Waves(2), press, 2));
  std::ostringstream csv;
  csv << "t,F\n";
  for (int i = 0; i <= 18; ++i) csv << 1.05 + 0.1 * i << "," << -0.1 * i << "\n";
  f.write("a.csv", csv.str());
  f.write("experiment.yaml",
          block_yaml("  - { file: a.avi, protocol: { mode: compression }, video: { scale: \"20 um\", start: \"1 s\", points: [ { name: platen, x: 50, y: 30 }, { name: base, x: 50, y: 100 } ] } }\n"));
  const Dataset d = load_dataset(f.path(), FILUM_SOURCE_DIR);
  const Eigen::VectorXd& u = d.trials[0].at("displacement");
  ASSERT_EQ(u.size(), 19);
  for (int i = 0; i <= 18; ++i) EXPECT_NEAR(u[i], -20e-6 * 0.2 * 25.0 * (0.05 + 0.1 * i), 20e-6 * 0.1) << i;
}

TEST(VideoTrial, MarkersUnderABladeSink) {
  Folder f;
  const auto sink = [](int k) { return std::array{0.0, 0.15 * k}; };
  ASSERT_TRUE(render(f.file("a.avi"), 40, 150, 100, 1.0, Waves(3), right_half(sink, 70), 3));
  std::ostringstream csv;
  csv << "t,z,F\n";
  for (int i = 0; i < 15; ++i) csv << 0.1 * i << "," << 0.05 * i << "," << 0.3 * i << "\n";
  f.write("a.csv", csv.str());
  f.write("experiment.yaml",
          "format: filum-experiment/1\nrig: spatula-press\nspecimen: { shape: box, length: \"60 mm\", width: \"50 mm\", height: \"20 mm\", blade_length: \"14 mm\", blade_width: \"7 mm\" }\n"
          "model: { file: brain/linear, free: [youngs_modulus] }\nchannels:\n  - { name: time, column: t, unit: s }\n  - { name: depth, column: z, unit: mm, kind: input }\n"
          "  - { name: force, column: F, unit: mN, kind: output }\n  - { name: u1, column: u1, unit: um, kind: output }\n  - { name: u2, column: u2, unit: um, kind: output }\n"
          "trials:\n  - { file: a.avi, protocol: { rate: \"1 mm/s\" }, video: { scale: \"10 um\", points: [ { name: u1, x: 30, y: 40 }, { name: u2, x: 110, y: 50 } ] } }\n");
  const Dataset d = load_dataset(f.path(), FILUM_SOURCE_DIR);
  for (int i = 0; i < 15; ++i) {
    EXPECT_NEAR(d.trials[0].at("u1")[i], 0.0, 1e-6) << i;
    EXPECT_NEAR(d.trials[0].at("u2")[i], 10e-6 * 0.15 * 25.0 * 0.1 * i, 1e-6) << i;
  }
}

TEST(VideoTrial, CreepIsNamedFromFilmsAlone) {
  // G = 1.5 at 10 mm of overhang and 0.51 at 7 mm; the modulus falls by J = 1 + 0.3 ln(1 + t/0.4 s); shapes by the trainer's rod
  Folder f;
  std::string trials;
  std::uint64_t seed = 10;
  for (const auto& [name, side, mm] : {std::tuple{"a.avi", "down", 10.0}, {"b.avi", "up", 10.0}, {"c.avi", "down", 7.0}, {"d.avi", "up", 7.0}}) {
    std::vector<double> drop;  // [px], at equal steps of ln J
    for (int i = 0; i <= 6; ++i) drop.push_back(mm * 1e-3 / kScale * hang_rod(1.5 * std::pow(0.1 * mm, 3) * (1.0 + 0.3 * std::log1p(7.5) * i / 6.0), {}, 40).drop);
    const auto sink = [drop](int k) {
      const double at = std::min(6.0 * std::log1p(k / 10.0) / std::log1p(7.5), 5.999);
      const auto i = static_cast<std::size_t>(at);
      return std::array{0.0, drop[i] + (at - static_cast<double>(i)) * (drop[i + 1] - drop[i]) - drop[0]};
    };
    ASSERT_TRUE(render(f.file(name), 75, 150, 130, 2.0, Waves(seed), right_half(sink, 70), seed));
    ++seed;
    std::ostringstream trial;
    trial << "  - { file: " << name << ", protocol: { orientation: " << side << ", overhang: \"" << mm << " mm\" }, video: { scale: \"50 um\", points: [ { name: clamp, x: 30, y: 20 }, { name: tip, x: 110, y: "
          << 20.0 + drop[0] << " } ] } }\n";
    trials += trial.str();
  }
  f.write("experiment.yaml", kThread + trials);
  const Result r = reconcile(load_dataset(f.path(), FILUM_SOURCE_DIR));
  ASSERT_EQ(r.decide.verdict, "effect") << r.decide.sentence;
  EXPECT_EQ(r.decide.effects[0].effect, Effect::bending_creep);
  ASSERT_TRUE(r.confirm.has_value());
  EXPECT_TRUE(r.confirm->holds);
}

/// Films of a block pressed by 0.6 mm at two speeds, with the force of relaxation g1 = 0.4, tau = 2 s, beside them. The platen's point comes to the edge behind
/// which its pattern vanishes (`deeper` 1) or beyond it.
void film_a_block(const Folder& f, double deeper, double seconds) {
  std::string trials;
  std::uint64_t seed = 50;
  Rng rng(77);
  for (const auto& [name, ramp] : {std::pair{"a", 0.8}, {"b", 3.2}, {"c", 0.8}}) {
    const auto depth = [ramp = ramp](double t) { return 30.0 * std::min(t / ramp, 1.0); };  // [px]
    const Origin press = [&](double x, double y, int k) { return y < 60 ? std::array{x, y - deeper * depth(k / 25.0)} : std::array{x, y}; };
    ASSERT_TRUE(render(f.file(std::string(name) + ".avi"), static_cast<int>(25 * seconds), 100, 140, 1.5, Waves(seed), press, seed));
    ++seed;
    std::ostringstream csv;
    csv << "t,F\n";
    double q = 0.0;  // of the branch that relaxes
    const double h = 0.04;
    for (int i = 0; h * i < seconds; ++i) {
      if (i > 0) q = q * std::exp(-h / 2.0) + 0.02 * (depth(h * i) - depth(h * (i - 1))) * 2.0 / h * -std::expm1(-h / 2.0);
      csv << h * i << "," << -20.0 * (0.6 * 0.02 * depth(h * i) + 0.4 * q) + 0.05 * rng.normal() << "\n";
    }
    f.write(std::string(name) + ".csv", csv.str());
    trials += "  - { file: " + std::string(name) + ".avi, protocol: { mode: compression, rate: \"" + std::to_string(0.6 / ramp) +
              " mm/s\" }, video: { scale: \"20 um\", points: [ { name: platen, x: 50, y: 30 }, { name: base, x: 50, y: 110 } ] } }\n";
  }
  f.write("experiment.yaml", block_yaml(trials));
}

TEST(VideoTrial, RelaxationOfABlockIsNamedFromFilms) {
  Folder f;
  film_a_block(f, 1.0, 8.0);
  const Result r = reconcile(load_dataset(f.path(), FILUM_SOURCE_DIR));
  ASSERT_EQ(r.decide.verdict, "effect") << r.decide.sentence;
  EXPECT_EQ(r.decide.effects[0].effect, Effect::viscoelastic_relaxation);
  EXPECT_NEAR(r.decide.effects[0].parameters[0].value, 0.4, 0.04);
  EXPECT_NEAR(r.decide.effects[0].parameters[1].value, 2.0, 0.2);
}

/// A blade filmed from the side on its way into tissue, of two sizes; the force beside it relaxes by g1 = 0.4 with tau = 2 s whatever the size.
TEST(VideoTrial, RelaxationUnderABladeIsNamedFromFilms) {
  Folder f;
  std::string trials;
  std::uint64_t seed = 80;
  Rng rng(78);
  for (const auto& [name, ramp, length, stiffness] : {std::tuple{"a", 0.8, 14, 20.0}, {"b", 3.2, 14, 20.0}, {"c", 0.8, 28, 41.0}, {"d", 3.2, 28, 41.0}}) {
    const auto depth = [ramp = ramp](double t) { return 30.0 * std::min(t / ramp, 1.0); };  // [px]
    ASSERT_TRUE(render(f.file(std::string(name) + ".avi"), 200, 100, 140, 1.5, Waves(seed), [&](double x, double y, int k) { return std::array{x, y - depth(k / 25.0)}; }, seed));
    ++seed;
    std::ostringstream csv;
    csv << "t,F\n";
    double q = 0.0;
    const double h = 0.04;
    for (int i = 0; i < 200; ++i) {
      if (i > 0) q = q * std::exp(-h / 2.0) + 0.02 * (depth(h * i) - depth(h * (i - 1))) * 2.0 / h * -std::expm1(-h / 2.0);
      csv << h * i << "," << stiffness * (0.6 * 0.02 * depth(h * i) + 0.4 * q) + 0.05 * rng.normal() << "\n";
    }
    f.write(std::string(name) + ".csv", csv.str());
    trials += "  - { file: " + std::string(name) + ".avi, protocol: { rate: \"" + std::to_string(0.6 / ramp) + " mm/s\" }, specimen: { blade_length: \"" + std::to_string(length) + " mm\", blade_width: \"" + std::to_string(length / 2) +
              " mm\" }, video: { scale: \"20 um\", points: [ { name: blade, x: 50, y: 40 } ] } }\n";
  }
  f.write("experiment.yaml",
          "format: filum-experiment/1\nrig: spatula-press\nspecimen: { shape: box, length: \"60 mm\", width: \"50 mm\", height: \"20 mm\", blade_length: \"14 mm\", blade_width: \"7 mm\" }\n"
          "model: { file: brain/linear, free: [youngs_modulus] }\nchannels:\n  - { name: time, column: t, unit: s }\n  - { name: depth, column: z, unit: mm, kind: input }\n  - { name: force, column: F, unit: mN, kind: output }\ntrials:\n" + trials);
  const Dataset d = load_dataset(f.path(), FILUM_SOURCE_DIR);
  for (const Trial& t : d.trials) EXPECT_NEAR(t.at("depth")[199], 0.6e-3, 2e-6);
  const Result r = reconcile(d);
  ASSERT_EQ(r.decide.verdict, "effect") << r.decide.sentence;
  EXPECT_EQ(r.decide.effects[0].effect, Effect::viscoelastic_relaxation);
  EXPECT_NEAR(r.decide.effects[0].parameters[0].value, 0.4, 0.04);
  EXPECT_NEAR(r.decide.effects[0].parameters[1].value, 2.0, 0.2);
}

TEST(VideoTrial, SaysWhatWasLostWhereAndWhy) {
  Folder f;
  film_a_block(f, 1.5, 4.0);
  try {
    load_dataset(f.path(), FILUM_SOURCE_DIR);
    FAIL() << "a platen that went out of sight was followed";
  } catch (const InputError& e) {
    const std::string what = e.what();
    for (const char* said : {"a.avi", "point platen", "lost after frame", "something came over it", "smaller `patch`"}) EXPECT_NE(what.find(said), std::string::npos) << what;
  }
}

TEST(VideoTrial, RefusesWithWhatWasExpected) {
  const auto refusal = [](const std::string& yaml, bool with_video) {
    Folder f;
    f.write("experiment.yaml", yaml);
    if (with_video) render(f.file("a.avi"), 8, 150, 110, 0.0, Waves(1), [](double x, double y, int) { return std::array{x, y}; }, 1);
    else f.write("a.avi", "no video");
    try {
      load_dataset(f.path(), FILUM_SOURCE_DIR);
    } catch (const InputError& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  const std::string good = kThread + thread_trial("a.avi", "down");
  const auto with = [&](const std::string& a, const std::string& b) { return std::string(good).replace(good.find(a), a.size(), b); };
  EXPECT_NE(refusal(good, false).find("a video that OpenCV can read"), std::string::npos);
  EXPECT_NE(refusal(with("name: tip,", "name: knee,"), true).find("points named clamp and tip"), std::string::npos);
  EXPECT_NE(refusal(with("scale: \"50 um\", ", ""), true).find("scale"), std::string::npos);
  EXPECT_NE(refusal(with("x: 110", "x: 148"), true).find("inside the picture"), std::string::npos);
  EXPECT_NE(refusal(block_yaml("  - { file: a.avi, protocol: { mode: compression }, video: { scale: \"20 um\", points: [ { name: platen, x: 50, y: 30 }, { name: base, x: 50, y: 80 } ] } }\n"), true).find("a.csv with time and a column \"F\""),
            std::string::npos);
}

}  // namespace video_trial_test
}  // namespace filum::reconcile
