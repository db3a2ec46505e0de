#include "training/retraction.h"

#include <gtest/gtest.h>

#include <cmath>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "training/pressure_map.h"
#include "training/task_session.h"

namespace filum {
namespace retraction_test {

std::string task_file(const std::string& name) { return std::string(FILUM_SOURCE_DIR) + "/curricula/" + name + "/task.yaml"; }

/// A scene whose pressure and exposure are set by hand.
struct Bench {
  SceneDescription scene;
  Observation o;
  TaskSession session;

  explicit Bench(const std::string& task, double compression = 1.0) : scene(described(compression)), session(load_task(task_file(task)), scene) {
    o.n_tools = scene.n_tools;
    o.brain.n_blades = scene.n_tools;
    for (auto& tool : o.tools) tool.input_valid = true;
  }
  static SceneDescription described(double compression) {
    SceneDescription d;
    d.n_tools = 2;
    d.brain.time_compression = compression;
    return d;
  }
  void hold(double mmhg, double seconds, double exposed = 0.0, const char* event = nullptr) {
    for (double t = 0.0; t < seconds - 1e-9; t += 0.01) {
      o.time += 0.01;
      o.brain.blades[0].peak = o.brain.blades[0].mean = mmhg * kMmHg;
      o.brain.exposed = exposed;
      o.n_events = event != nullptr && t == 0.0 ? 1 : 0;
      o.events[0] = {event != nullptr ? event : "", 0, 1.0, "-"};
      session.observe(o);
    }
  }
};

/// A device that is waited for costs nothing; a blade that is moved meanwhile presses on the clock, and meets no goal.
TEST(Retraction, PressureCountsWhileAnotherDeviceIsSilentAndThisOneWorks) {
  Bench b("press-to-target");
  b.hold(0, 1);
  b.o.tools[1].input_valid = false;
  b.hold(25, 10);
  EXPECT_EQ(b.session.finish().pressure->dose, 0.0);
  b.o.tools[0].X_WT.p.x() += 1e-3;
  b.hold(25, 10);
  const PressureReport waited = *b.session.finish().pressure;
  EXPECT_NEAR(waited.peak / kMmHg, 25.0, 1e-9);
  EXPECT_GT(waited.dose, 0.0);
  b.hold(15, 10);
  EXPECT_EQ(b.session.status().step_index, 0);
}

TEST(Retraction, PressingToTheBandThreeTimesPasses) {
  Bench b("press-to-target");
  for (int k = 0; k < 3; ++k) {
    b.hold(15, 4);
    b.hold(0, 2);
  }
  EXPECT_TRUE(b.session.done());
  const Result r = b.session.finish();
  EXPECT_TRUE(r.passed) << (r.verdict.empty() ? "" : r.verdict[0]);
  ASSERT_TRUE(r.pressure);
  EXPECT_NEAR(r.pressure->peak / kMmHg, 15.0, 1e-9);
  EXPECT_NEAR(r.pressure->press_error, 0.0, 1e-6);
  EXPECT_EQ(r.pressure->releases, 3);
  for (const ScoreItem& item : r.items) EXPECT_FALSE(item.why.empty());
}

TEST(Retraction, TheWrongPressureNeverEndsTheStep) {
  Bench b("press-to-target");
  b.hold(25, 30);
  EXPECT_EQ(b.session.status().step_index, 0);
  const Result r = b.session.finish();
  EXPECT_FALSE(r.finished);
  EXPECT_FALSE(r.passed);
  EXPECT_EQ(r.total, 0.0);  // a low peak earns nothing when the task was not done
}

TEST(Retraction, LeavingTheBandBeginsTheTimeAnew) {
  Bench b("press-to-target");
  b.hold(15, 2.5);
  b.hold(22, 0.1);
  b.hold(15, 2.5);
  EXPECT_EQ(b.session.status().step_index, 0);
  b.hold(15, 0.7);
  EXPECT_EQ(b.session.status().step_index, 1);
}

TEST(Retraction, SlipsAndCutsAreCountedAndWarned) {
  Bench b("press-to-target");
  b.hold(15, 1, 0.0, "slip");
  b.hold(45, 1, 0.0, "edge-cut");
  EXPECT_EQ(b.session.retraction()->report().slips, 1);
  EXPECT_EQ(b.session.retraction()->report().edge_cuts, 1);
  bool alarmed = false;
  for (const TaskWarning& w : b.session.status().warnings) alarmed = alarmed || w.code == "pressure-alarm";
  EXPECT_TRUE(alarmed);
}

TEST(Retraction, TimesAreThePatientsWhereTheSceneIsCompressed) {
  Bench b("press-to-target", 10.0);
  b.hold(15, 0.35);  // 3.5 s
  EXPECT_EQ(b.session.status().step_index, 1);
  EXPECT_NEAR(b.session.retraction()->report().time_in_band[0] + b.session.retraction()->report().time_in_band[1], 3.4, 0.01);
}

TEST(Retraction, AnExposureOnTheArmCountsOnlyWhileTheArmHoldsBelowTheLimit) {
  Bench b("retractor-correction");
  b.hold(40, 6);
  b.hold(0, 6);
  b.hold(30, 12, 0.9);
  EXPECT_EQ(b.session.status().step_index, 2) << "above the limit";
  b.hold(10, 11, 0.9);
  EXPECT_EQ(b.session.status().step_index, 3);
  b.hold(10, 70, 0.9);
  EXPECT_FALSE(b.session.done()) << "in the hand";
  b.o.brain.blades[0].parked = true;
  b.hold(10, 61, 0.9);
  EXPECT_TRUE(b.session.done());
  const Result r = b.session.finish();
  EXPECT_NEAR(r.pressure->hold_peak / kMmHg, 10.0, 1e-9);
  EXPECT_NEAR(r.pressure->peak / kMmHg, 40.0, 1e-9);
}

TEST(Retraction, BlindStepsAreSaidToBeBlindAndWarnOfNothing) {
  Bench b("press-to-target");
  b.hold(39, 1);
  EXPECT_FALSE(b.session.status().blind);
  EXPECT_FALSE(b.session.status().warnings.empty());
  b.hold(15, 4);
  b.hold(0, 2);
  b.hold(39, 1);
  EXPECT_TRUE(b.session.status().blind);
  EXPECT_TRUE(b.session.status().warnings.empty());
}

TEST(Retraction, TheMapHoldsTheLargestPressureOfEachMomentAndPlace) {
  Bench b("press-to-target");
  b.o.brain.pressure = {0.0, 20.0 * kMmHg};
  b.o.brain.blades[0].profile[2] = 20.0 * kMmHg;
  b.hold(20, 60);
  PressureReport p = b.session.retraction()->report();
  p.blade_names = {"spatula"};
  const nlohmann::ordered_json map = pressure_map_json(p);
  EXPECT_GT(map["time"].size(), 300u);
  EXPECT_LE(map["time"].size(), kMapColumns);
  EXPECT_EQ(map["blades"][0]["pressure"].size(), map["time"].size() * static_cast<std::size_t>(kProfileBins));
  EXPECT_EQ(map["blades"][0]["pressure"][2], 20.0);
  EXPECT_EQ(map["blades"][0]["pressure"][3], 0.0);
  EXPECT_EQ(map["peak"][1], 20.0);
  EXPECT_NEAR(map["dose"][1].get<double>(), 10.0, 0.1);  // 10 mmHg above the threshold for a minute
  EXPECT_EQ(map["dose"][0], 0.0);
}

TEST(Retraction, GoalsThatAskForNothingAreRefused) {
  EXPECT_THROW(parse_goal(YamlNode::parse("{ kind: press, from: \"20 mmHg\", to: \"10 mmHg\", for: \"3 s\" }", "t")), InputError);
  EXPECT_THROW(parse_goal(YamlNode::parse("{ kind: expose, for: \"3 s\" }", "t")), InputError);
  EXPECT_THROW(parse_goal(YamlNode::parse("{ kind: squeeze, for: \"3 s\" }", "t")), InputError);
}

}  // namespace retraction_test
}  // namespace filum
