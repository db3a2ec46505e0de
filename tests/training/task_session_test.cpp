#include "training/task_session.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/training/scripted_scene.h"
#include "training/result_json.h"

namespace filum {
namespace task_session_test {

using namespace shapes;

Task task_named(const std::string& name) {
  return load_task(std::string(FILUM_SOURCE_DIR) + "/curricula/" + name + "/task.yaml");
}

/// Plays a whole tie of these throws in front of a session, tails cut `tail` nodes from the end at the end.
class Tie {
 public:
  explicit Tie(const std::string& task, const std::vector<int>& throws)
      : session(task_named(task), knot_scene()) {
    hold(throws_round_post({}), 0.5, 0.0);
    for (std::size_t n = 1; n <= throws.size(); ++n) {
      const std::vector<int> so_far(throws.begin(), throws.begin() + static_cast<std::ptrdiff_t>(n));
      hold(wound_round(scene.now().tools[1].X_WT.p, 1.0), 0.5, 0.0);
      hold(throws_round_post(so_far), 1.5, 0.0);
      hold(throws_round_post(so_far), 1.5, 30e-3);
    }
  }
  void hold(const Points& nodes, double seconds, double tension) {
    scene.show(nodes, tension);
    const double moves_from = scene.now().time;
    for (int k = 0; k < static_cast<int>(seconds / 0.002); ++k) {
      const double s = std::min(1.0, (scene.now().time - moves_from) / 0.5);
      // 5 mm to and fro in half a second: one movement of each hand.
      const double x = 5e-3 * s * s * s * (10.0 - 15.0 * s + 6.0 * s * s);
      scene.now().tools[0].X_WT.p.y() = x;
      scene.now().tools[1].X_WT.p.y() = -x;
      scene.now().tools[1].grip_force = tension > 0.0 ? 0.5 : 0.0;
      session.observe(scene.next());
      scene.now().n_events = 0;
    }
  }
  void cut() {
    scene.now().cut_edge_low = 7;
    scene.now().cut_edge_high = scene.now().n_nodes - 9;
    for (int k = 0; k < 200; ++k) session.observe(scene.next());
  }
  void world_event(const char* name) {
    scene.now().n_events = 1;
    scene.now().events[0] = {name, 1, 0.0, "-"};
    session.observe(scene.next());
    scene.now().n_events = 0;
  }
  Scene scene;
  TaskSession session;
};

const ScoreItem& item(const Result& r, const std::string& name) {
  return *std::find_if(r.items.begin(), r.items.end(), [&](const ScoreItem& i) { return i.name == name; });
}

bool warns(const TaskStatus& status, const std::string& code) {
  return std::any_of(status.warnings.begin(), status.warnings.end(),
                     [&](const TaskWarning& w) { return w.code == code; });
}

const SecurityTest kHeld{true, 60e-3, 60e-3, 0.1e-3};

TEST(TaskSession, ASquareKnotPassesWithReasons) {
  Tie run("knot-square", {3, -3});
  run.cut();
  EXPECT_TRUE(run.session.done());
  const Result r = run.session.finish(kHeld);
  EXPECT_TRUE(r.finished);
  EXPECT_TRUE(r.passed) << (r.verdict.empty() ? "" : r.verdict.front());
  EXPECT_EQ(r.knot.knot_class, "square");
  EXPECT_TRUE(r.knot.encloses_post);
  EXPECT_EQ(item(r, "knot-class").points, 25.0);
  EXPECT_EQ(item(r, "throws").number, 2.0);
  EXPECT_EQ(item(r, "security").points, 15.0);
  EXPECT_NEAR(*item(r, "security").number, 60.0, 1e-9);  // shown in mN
  EXPECT_EQ(item(r, "time").points, 15.0);
  EXPECT_GT(item(r, "tail-lengths").number.value_or(0.0), 0.1);
  EXPECT_LT(item(r, "tail-lengths").number.value_or(99.0), 5.0);
  EXPECT_NEAR(r.measures.overload, 30e-3 / 0.16, 1e-9);
  EXPECT_NEAR(r.measures.grip_peak, 0.5, 1e-9);
  double total = 0.0;
  for (const ScoreItem& i : r.items) {
    total += i.points;
    EXPECT_FALSE(i.why.empty()) << i.name;
    EXPECT_NE(i.why.find("Source: "), std::string::npos) << i.name;
    EXPECT_LE(i.points, i.max_points);
    EXPECT_GE(i.points, 0.0);
  }
  EXPECT_NEAR(total, r.total, 1e-9);
}

TEST(TaskSession, AGrannyIsCalledAGrannyAndDoesNotPass) {
  Tie run("knot-granny", {3, 3});
  run.cut();
  const Result r = run.session.finish(kHeld);
  EXPECT_TRUE(r.finished);
  EXPECT_EQ(r.knot.knot_class, "granny");
  EXPECT_FALSE(r.passed);
  EXPECT_EQ(item(r, "knot-class").points, 0.0);
  EXPECT_NE(item(r, "knot-class").why.find("granny"), std::string::npos);
  Tie in_earnest("knot-square", {-3, -3});
  in_earnest.cut();
  EXPECT_FALSE(in_earnest.session.finish(kHeld).passed);
  EXPECT_TRUE(warns(in_earnest.session.status(), "wrong-knot"));
}

TEST(TaskSession, ASurgeonsKnotPassesItsTaskOnly) {
  Tie right("knot-surgeons", {5, -3});
  right.cut();
  EXPECT_TRUE(right.session.finish(kHeld).passed);
  Tie wrong("knot-square", {5, -3});
  wrong.cut();
  EXPECT_FALSE(wrong.session.finish(kHeld).passed);
  Tie square("knot-surgeons", {3, -3});
  square.cut();
  EXPECT_FALSE(square.session.finish(kHeld).passed);
}

TEST(TaskSession, DoesNotPassUnfinishedUntestedBrokenOrSlipping) {
  Tie run("knot-square", {3, -3});
  EXPECT_FALSE(run.session.finish(kHeld).passed) << "tails not cut";
  EXPECT_EQ(item(run.session.finish(kHeld), "tail-lengths").points, 0.0);
  run.cut();
  EXPECT_FALSE(run.session.finish().passed) << "not pulled";
  EXPECT_FALSE(item(run.session.finish(), "security").number.has_value());
  EXPECT_FALSE(run.session.finish(SecurityTest{false, 2e-3, 60e-3, 1e-3}).passed) << "slipped at 2 mN";
  EXPECT_TRUE(run.session.finish(kHeld).passed);
  run.scene.now().broken = true;
  run.scene.now().break_edge = 1;
  run.session.observe(run.scene.next());
  EXPECT_FALSE(run.session.finish(kHeld).passed);
  EXPECT_TRUE(warns(run.session.status(), "thread-broken"));
}

TEST(TaskSession, ScoredTimeStandsStillWhileAnInputIsSilent) {
  Tie run("knot-square", {3});
  const double before = run.session.status().elapsed;
  EXPECT_GT(before, 3.0);
  run.scene.now().tools[0].input_valid = false;
  for (int k = 0; k < 500; ++k) run.session.observe(run.scene.next());
  EXPECT_NEAR(run.session.status().elapsed, before, 1e-9);
  EXPECT_TRUE(run.session.status().paused);
  EXPECT_TRUE(warns(run.session.status(), "input-lost"));
  run.scene.now().tools[0].input_valid = true;
  for (int k = 0; k < 500; ++k) run.session.observe(run.scene.next());
  EXPECT_NEAR(run.session.status().elapsed, before + 1.0, 0.01);
  EXPECT_FALSE(warns(run.session.status(), "input-lost"));
}

/// What is tied meanwhile stays in the scene, so its time is told with it.
TEST(TaskSession, WorkWhileAnInputIsSilentMeetsNoStepAndTakesItsTime) {
  Tie run("knot-square", {3});
  const TaskStatus before = run.session.status();
  run.scene.now().tools[0].input_valid = false;
  for (int k = 0; k < 2; ++k) run.hold(throws_round_post({3, -3}), 20.0, 30e-3);
  const TaskStatus silent = run.session.status();
  EXPECT_TRUE(silent.paused);
  EXPECT_EQ(silent.step_index, before.step_index);
  EXPECT_NEAR(silent.elapsed, before.elapsed + 40.0, 0.5);
  run.scene.now().tools[0].input_valid = true;
  for (int k = 0; k < 2; ++k) run.hold(throws_round_post({3, -3}), 1.5, 30e-3);
  run.cut();
  EXPECT_TRUE(run.session.done());
  EXPECT_GT(run.session.finish(kHeld).seconds, before.elapsed + 40.0);
}

TEST(TaskSession, WarnsWhileAVesselsWallIsHeldThroughItsThickness) {
  SceneDescription vessel = knot_scene();
  vessel.tissue.lumen = true;
  const auto warned = [](const SceneDescription& scene, const GripObservation& grip) {
    TaskSession session(task_named("artery-stitch"), scene);
    Scene shown;
    shown.now().tissue.grips[1] = grip;
    session.observe(shown.next());
    return warns(session.status(), "wall-held");
  };
  EXPECT_TRUE(warned(vessel, {true, true, 1e-3}));
  EXPECT_FALSE(warned(vessel, {true, false, 1e-3})) << "adventitia may be held";
  EXPECT_FALSE(warned(vessel, {}));
  EXPECT_FALSE(warned(knot_scene(), {true, true, 1e-3})) << "a card has no intima";
}

TEST(TaskSession, HintsAndWarningsFollowTheTrainee) {
  Tie run("knot-square", {3});
  TaskStatus status = run.session.status();
  EXPECT_EQ(status.step_index, 4);
  EXPECT_EQ(status.steps.size(), 9u);
  EXPECT_EQ(status.step_name, "Second throw: loop");
  EXPECT_NE(status.hint.find("other way"), std::string::npos);
  EXPECT_TRUE(status.warnings.empty());
  run.hold(throws_round_post({3}), 0.1, 0.15);
  run.scene.now().tools[1].grip_force = 9.0;
  run.session.observe(run.scene.next());
  status = run.session.status();
  EXPECT_TRUE(warns(status, "thread-overload"));
  EXPECT_TRUE(warns(status, "grip"));
}

TEST(TaskSession, CountsDropsAndKeepsWorldEvents) {
  Tie run("knot-square", {3, -3});
  run.world_event("drop");
  run.world_event("grasp");
  run.world_event("drop");
  run.cut();
  const Result r = run.session.finish(kHeld);
  EXPECT_EQ(r.measures.drops, 2);
  EXPECT_NEAR(item(r, "drops").points, 2.5, 1e-9);
  const std::size_t before = run.session.events().size();
  for (int k = 0; k < 5000; ++k) run.world_event("slip");  // 10 s, one every step
  EXPECT_EQ(run.session.events().size() - before, 40u);
  for (int k = 0; k < 5000; ++k) run.world_event("grasp");
  EXPECT_EQ(run.session.events().size(), TaskSession::kMaxEvents);
}

TEST(TaskSession, CurvesAreThinnedButKeepTheirPeaks) {
  Tie run("knot-square", {3, -3});
  run.hold(throws_round_post({3, -3}), 15.0, 0.02);
  run.hold(throws_round_post({3, -3}), 0.004, 0.11);
  run.hold(throws_round_post({3, -3}), 10.0, 0.02);
  const Result r = run.session.finish();
  ASSERT_FALSE(r.series.empty());
  for (const Curve& c : r.series) {
    EXPECT_LE(c.time.size(), kMaxCurvePoints);
    EXPECT_GT(c.time.size(), kMaxCurvePoints / 3);
    EXPECT_EQ(c.time.size(), c.value.size());
  }
  EXPECT_NEAR(*std::max_element(r.series[0].value.begin(), r.series[0].value.end()), 0.11, 1e-12);
  ASSERT_EQ(r.paths.size(), 2u);
  EXPECT_EQ(r.paths[0].positions.size(), 3 * r.paths[0].time.size());
}

TEST(TaskSession, JsonHasTheKeysAgreedOn) {
  Tie run("knot-square", {3, -3});
  run.cut();
  const auto json = nlohmann::json::parse(result_json(run.session.finish(kHeld)));
  for (const char* key :
       {"task", "finished", "passed", "seconds", "score", "knot", "events", "series", "paths"}) {
    EXPECT_TRUE(json.contains(key)) << key;
  }
  EXPECT_EQ(json["knot"]["class"], "square");
  EXPECT_NEAR(json["knot"]["security_newton"].get<double>(), 60e-3, 1e-12);
  for (const auto& line : json["score"]["items"]) {
    for (const char* key : {"name", "value", "unit", "points", "why"}) EXPECT_TRUE(line.contains(key)) << key;
  }
  EXPECT_EQ(json["knot_report"]["composition"], "1=1");
  const auto viewer = nlohmann::json::parse(result_json(run.session.finish(), false));
  EXPECT_TRUE(viewer["verdict"].is_array()) << "a trainee is told why";
  EXPECT_TRUE(viewer["knot"]["security_newton"].is_null());
}

TEST(TaskSession, DoingNothingEarnsNothing) {
  Tie run("knot-square", {});
  const Result r = run.session.finish();
  for (const ScoreItem& i : r.items) {
    if (i.name == "sparc" || i.name == "ldlj") continue;
    EXPECT_EQ(i.points, 0.0) << i.name << ": " << i.why;
  }
}

TEST(TaskSession, NothingSeenGivesAResultToo) {
  const TaskSession session(task_named("knot-square"), knot_scene());
  const Result r = session.finish();
  EXPECT_FALSE(r.passed);
  EXPECT_FALSE(r.finished);
  EXPECT_EQ(r.knot.knot_class, "unknot");
  EXPECT_FALSE(result_json(r).empty());
  EXPECT_TRUE(session.status().warnings.empty());
}

TEST(TaskSession, SameObservationsSameResult) {
  Tie a("knot-square", {3, -3}), b("knot-square", {3, -3});
  EXPECT_EQ(result_json(a.session.finish(kHeld)), result_json(b.session.finish(kHeld)));
}

}  // namespace task_session_test
}  // namespace filum
