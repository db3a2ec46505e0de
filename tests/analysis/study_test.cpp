// Sessions made by hand, with a known squeeze, error and tremor in each part.
#include "analysis/study.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <random>

#include "analysis/noise_floor.h"
#include "analysis/study_page.h"

namespace filum {
namespace study_test {

constexpr double kSeconds = 24.0, kRate = 500.0, kTone = 9.0;  // [s], [Hz], [Hz]

struct Made {
  std::string input = "haptic 18930", code, task = "tip-hold";
  double amplitude = 50e-6, noise = 1e-6, force = 0.2, error = 100e-6;
  unsigned seed = 1;
};

/// Each part of 4 s: force, error and amplitude as made, times 1, 1.1, 1.2 ...
RecordedSession made(const Made& m, const std::string& id = "a") {
  RecordedSession s;
  s.file = id;
  s.meta.task = m.task;
  s.meta.input = m.input;
  s.meta.participant = m.code;
  s.seconds = kSeconds;
  ToolSeries tool;
  std::mt19937 random(m.seed);
  std::normal_distribution<double> normal(0.0, m.noise);
  const auto n = static_cast<int>(kSeconds * kRate);
  tool.hand.p.resize(3, n);
  tool.grip.source = "device";
  for (int k = 0; k < n; ++k) {
    const double t = k / kRate, growth = 1.0 + 0.1 * std::floor(t / 4.0);
    tool.hand.clock.push_back(t);
    tool.hand.p.col(k) = Vec3(growth * m.amplitude * std::sin(2.0 * std::numbers::pi * kTone * t) + normal(random), normal(random), normal(random));
    tool.grip.force.push_back(k % 2 == 0 ? growth * m.force : 0.0);  // squeezed half of the time
    if (k % 500 == 499) tool.target_error.push_back({t, growth * m.error});
  }
  tool.hand.scene = tool.grip.clock = tool.grip.scene = tool.hand.clock;
  tool.scene = tool.hand;
  s.tools.push_back(tool);
  return s;
}

RecordedSession clamped(const std::string& input, double noise) {
  Made still;
  still.input = input;
  still.amplitude = 0.0;
  still.noise = noise;
  still.seed = 77;
  return made(still, "vice");
}

TEST(Study, APartHasItsSqueezeItsErrorAndItsTremorFreeOfTheFloor) {
  const RecordedSession still = clamped("haptic 18930", 5e-6);
  Made m;
  m.noise = 5e-6;
  const StudySession s = study_session(made(m), &still);
  EXPECT_EQ(s.tremor_why, "");
  EXPECT_EQ(s.floor_source, "clamped tool: vice");
  // White noise of 5 um in each of three axes, one-sided over 250 Hz: 6 of them in the band.
  EXPECT_NEAR(s.floor, 5e-6 * std::sqrt(3.0 * 6.0 / 250.0), 0.2e-6);
  ASSERT_EQ(s.parts.size(), 6u);
  for (std::size_t k = 0; k < 6; ++k) {
    const double growth = 1.0 + 0.1 * static_cast<double>(k);
    EXPECT_NEAR(s.parts[k].force, 0.2 * growth, 1e-9) << "of the time it squeezed";
    EXPECT_NEAR(s.parts[k].accuracy, 100e-6 * growth, 1e-9);
    EXPECT_NEAR(s.parts[k].tremor, 50e-6 * growth / std::numbers::sqrt2, 1e-6);
  }
  EXPECT_NEAR(s.mean.force, 0.25, 1e-9);
}

TEST(Study, TremorThatItsDeviceCannotResolveIsNotCorrelatedWithAnything) {
  const StudySession none = study_session(made({}), nullptr);
  EXPECT_NE(none.tremor_why.find("noise floor not measured"), std::string::npos);
  EXPECT_TRUE(std::isnan(none.mean.tremor));
  EXPECT_FALSE(std::isnan(none.mean.force));
  const RecordedSession loud = clamped("haptic 18930", 1e-3);
  const StudySession drowned = study_session(made({}), &loud);
  EXPECT_EQ(drowned.tremor_why, "not above the device's noise floor");
  const auto pairs = study_pairs({none, drowned});
  EXPECT_EQ(pairs[1].windows.n, 0);
  EXPECT_EQ(pairs[0].windows.n, 12);
}

TEST(Study, AFloorIsOfTheSameDevice) {
  const std::vector<RecordedSession> still = {clamped("igtl 18944", 5e-6), clamped("haptic 18930", 1e-6)};
  EXPECT_EQ(clamped_like(made({}), still), &still[1]);
  Made mouse;
  mouse.input = "pointer";
  EXPECT_EQ(clamped_like(made(mouse), still), nullptr);
}

/// Within each session the error grows with the force, across sessions and people it falls: Simpson's paradox.
std::vector<StudySession> paradox() {
  std::vector<StudySession> list;
  for (int k = 0; k < 8; ++k) {
    StudySession s;
    s.id = "s" + std::to_string(k);
    s.task = "trace";
    s.participant = "P" + std::to_string(k / 2);
    for (int part = 0; part < 5; ++part) s.parts.push_back({0.1 * (k + 1) + 0.01 * part, 1e-3 - 1e-4 * k + 1e-5 * part, std::numeric_limits<double>::quiet_NaN()});
    list.push_back(std::move(s));
  }
  return list;
}

TEST(Study, LevelsAreKeptApart) {
  const auto pairs = study_pairs(paradox());
  EXPECT_NEAR(pairs[0].windows.r, 1.0, 1e-9);
  EXPECT_EQ(pairs[0].windows.n, 40);
  EXPECT_NEAR(pairs[0].sessions.r, -1.0, 1e-9);
  EXPECT_EQ(pairs[0].sessions.n, 8);
  EXPECT_NEAR(pairs[0].within_people.r, -1.0, 1e-9);
  EXPECT_EQ(pairs[0].within_people.groups, 4);
  EXPECT_NEAR(pairs[0].people.r, -1.0, 1e-9);
  EXPECT_EQ(pairs[0].people.n, 4);
  EXPECT_NEAR(pairs[0].people.slope, -1e-3, 1e-12);
  EXPECT_NE(pairs[1].windows.why, "");
}

TEST(Study, AnObjectIsAPartWithTheErrorOfItsPlace) {
  RecordedSession s = made({});
  ToolSeries& tool = s.tools[0];
  tool.held = {{2.0, 6.0, 0.05, false}, {8.0, 12.0, 0.05, false}};
  tool.target_error = {{7.0, 300e-6}, {12.5, 500e-6}, {20.0, 1.0}};  // the last one long after
  const StudySession studied = study_session(s, nullptr);
  ASSERT_EQ(studied.parts.size(), 2u);
  EXPECT_NEAR(studied.parts[0].accuracy, 300e-6, 1e-12);
  EXPECT_NEAR(studied.parts[1].accuracy, 500e-6, 1e-12);
}

TEST(Study, TasksAreNotMixedAndFilesSayHowTheyWereMade) {
  std::vector<StudySession> list = paradox();
  Made other;
  other.code = "a<script>";
  list.push_back(study_session(made(other, "x\"y"), nullptr));
  const Study study = study_of(list, "filum 1");
  ASSERT_EQ(study.tasks.size(), 2u);
  EXPECT_EQ(study.tasks[1].people, 4u);
  const std::string page = study_page(study);
  for (const char* word : {"across the sessions of one person", "large", "Spearman", "filum 1", "segment_s", "not resolved: noise floor not measured"}) EXPECT_NE(page.find(word), std::string::npos) << word;
  EXPECT_EQ(page.find("<script>"), std::string::npos);
  EXPECT_EQ(page.find("nan"), std::string::npos);
  EXPECT_NE(sessions_csv(study).find("\"x\"\"y\",\"tip-hold\""), std::string::npos);
  const std::string parts = parts_csv(study);
  EXPECT_EQ(std::count(parts.begin(), parts.end(), '\n'), 1 + 40 + 6);
  EXPECT_NE(parts.find("\"filum 1\""), std::string::npos);
  const auto json = study_json(study);
  EXPECT_EQ(json["tasks"][1]["correlation"]["force_accuracy"]["people"]["n"], 4);
  EXPECT_EQ(json["settings"]["correlation_window_s"], 4.0);
  EXPECT_EQ(study_plot(study, "knot-square"), "");
}

}  // namespace study_test
}  // namespace filum
