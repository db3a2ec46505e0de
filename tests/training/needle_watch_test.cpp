#include "training/needle_watch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace filum {
namespace needle_watch_test {

constexpr double kDt = 2e-3, kRightAngle = 1.5707963267948966;

NeedleTask loading() {
  NeedleTask task;
  NeedleGoal pick, load, present;
  pick.kind = NeedleGoal::Kind::pick;
  load.kind = NeedleGoal::Kind::load;
  load.tool = 1;
  load.low = 0.5;
  load.high = 0.75;
  load.angle = 0.26;
  load.seconds = 0.1;
  present.kind = NeedleGoal::Kind::present;
  present.at = Vec3(1e-3, 0, 0);
  present.within = 0.2e-3;
  present.seconds = 0.1;
  task.goals = {pick, load, present};
  return task;
}

Observation field() {
  Observation o;
  o.n_tools = 2;
  o.needle.present = true;
  return o;
}

void watch(NeedleWatch& w, const Observation& o, double seconds, std::vector<TaskEvent>& events) {
  for (double t = 0; t < seconds; t += kDt) w.observe(o, kDt, true, events);
}

TEST(NeedleWatch, GoalsAreMetInTurnAndHeldAsLongAsAskedFor) {
  NeedleWatch w(loading(), {});
  std::vector<TaskEvent> events;
  Observation o = field();
  watch(w, o, 0.2, events);
  EXPECT_EQ(w.step(), 0);
  o.needle.held[0] = true;
  o.needle.X_WN.p.z() = 2e-3;
  watch(w, o, 0.01, events);
  EXPECT_EQ(w.step(), 1);
  o.needle.held[1] = true;  // both hold it: not loaded yet
  o.needle.grip_share[1] = 0.6;
  o.needle.grip_angle[1] = kRightAngle - 0.1;
  watch(w, o, 0.3, events);
  EXPECT_EQ(w.step(), 1);
  o.needle.held[0] = false;
  watch(w, o, 0.05, events);
  EXPECT_EQ(w.step(), 1) << "not yet long enough";
  watch(w, o, 0.1, events);
  EXPECT_EQ(w.step(), 2);
  o.needle.point_W = Vec3(1e-3, 0.1e-3, 0);
  watch(w, o, 0.2, events);
  EXPECT_TRUE(w.done());
  EXPECT_EQ(events.size(), 3u);
  const NeedleReport r = w.report();
  EXPECT_NEAR(r.angle_error, 0.1, 1e-6);
  EXPECT_NEAR(r.share, 0.6, 1e-9);
  EXPECT_NEAR(r.present_error, 0.1e-3, 1e-9);
}

TEST(NeedleWatch, WrongPlaceOrAngleIsNotLoaded) {
  for (const bool place : {true, false}) {
    NeedleWatch w(loading(), {});
    std::vector<TaskEvent> events;
    Observation o = field();
    o.needle.held[0] = true;
    o.needle.X_WN.p.z() = 2e-3;
    watch(w, o, 0.01, events);
    o.needle.held = {false, true, false};
    o.needle.grip_share[1] = place ? 0.2 : 0.6;
    o.needle.grip_angle[1] = place ? kRightAngle : kRightAngle - 0.5;
    watch(w, o, 1.0, events);
    EXPECT_EQ(w.step(), 1);
  }
}

TEST(NeedleWatch, EyesAreTakenInTurnAtTheirMarks) {
  NeedleTask task;
  for (const double x : {0.0, 1e-3}) {
    NeedleGoal eye;
    eye.kind = NeedleGoal::Kind::eye;
    eye.at = Vec3(x, 0, 0);
    eye.out = Vec3(x, 2e-3, 0);
    eye.within = 0.3e-3;
    task.goals.push_back(eye);
  }
  NeedleWatch w(task, {});
  std::vector<TaskEvent> events;
  Observation o = field();
  const auto pass = [&](int k, Vec3 in, Vec3 out, bool is_out) {
    PassObservation& p = o.tissue.passes[static_cast<std::size_t>(k)];
    p.entry_rest = in;
    p.exit_rest = out;
    p.out = is_out;
    o.tissue.n_passes = k + 1;
    w.observe(o, kDt, true, events);
  };
  pass(0, Vec3(1e-3, 0, 0), Vec3(1e-3, 2e-3, 0), true);
  EXPECT_EQ(w.step(), 0) << "the second eye is not the first's turn";
  pass(1, Vec3(0.1e-3, 0, 0.1e-3), Vec3(0, 0.3e-3, 0), true);  // down through the card
  pass(2, Vec3(0, 1.8e-3, 0), Vec3(0, 2.2e-3, 0), false);
  EXPECT_EQ(w.step(), 0) << "not out yet";
  pass(2, Vec3(0, 1.8e-3, 0), Vec3(0, 2.2e-3, 0), true);
  EXPECT_EQ(w.step(), 1);
  pass(3, Vec3(1e-3, 0, 0), Vec3(1.4e-3, 2e-3, 0), true);
  EXPECT_EQ(w.step(), 1) << "0.4 mm beside the mark";
  pass(4, Vec3(1e-3, 0, 0), Vec3(1e-3, 2e-3, 0), true);
  EXPECT_TRUE(w.done());
  EXPECT_NEAR(w.report().present_error, std::sqrt((0.01 + 0.04) / 4.0) * 1e-3, 1e-12) << "0.1 and 0.2 mm off, then none";
}

TEST(NeedleWatch, FollowsClampsAndMilking) {
  NeedleTask task;
  task.has_tissue = true;
  NeedleWatch w(task, {});
  std::vector<TaskEvent> events;
  Observation o = field();
  BloodObservation& b = o.tissue.blood;
  b.present = true;
  b.least_area = 0.3e-6;
  const auto see = [&](double time, const char* name, double value) {
    o.time = time;
    o.n_events = name == nullptr ? 0 : 1;
    if (name != nullptr) o.events[0] = {name, -1, value, "-"};
    w.observe(o, kDt, true, events);
  };
  see(1.0, nullptr, 0.0);
  EXPECT_FALSE(w.report().clamps.has_value());
  b.wrong_order = true;
  b.least_area = 0.5e-6;
  b.leaks = 2e-7;
  see(2.0, "clamp-off", 1.0);
  b.leaks = 1e-7;
  b.pressure = {13000.0, 12900.0};
  see(3.0, "clamp-off", 0.0);
  see(4.0, "milking-let-go", 0.4);
  see(4.1, "milking-refilled", 0.02);
  const NeedleReport r = w.report();
  ASSERT_TRUE(r.clamps.has_value() && r.milking.has_value());
  EXPECT_EQ(r.clamps->downstream, 2.0);
  EXPECT_EQ(r.clamps->upstream, 3.0);
  EXPECT_TRUE(r.clamps->wrong_order);
  EXPECT_EQ(r.clamps->area_before, 0.3e-6);
  EXPECT_EQ(r.clamps->area, 0.5e-6);
  EXPECT_EQ(r.clamps->most_leak, 2e-7);
  EXPECT_EQ(r.clamps->leak, 1e-7);
  EXPECT_EQ(r.milking->tests(), 1);
  EXPECT_EQ(r.milking->seconds, 0.02);
  EXPECT_NEAR(r.milking->volume, 4e-10, 1e-20);
}

TEST(NeedleWatch, AdventitiaIsHeldOnItsSideWithThePullAskedFor) {
  NeedleTask task;
  NeedleGoal grasp;
  grasp.kind = NeedleGoal::Kind::grasp;
  grasp.tool = 1;
  grasp.side = 1;
  grasp.low = 0.3e-3;
  grasp.high = 2e-3;
  grasp.seconds = 0.1;
  task.goals = {grasp};
  const auto met_by = [&](std::size_t tool, const GripObservation& grip, double seconds = 0.2) {
    NeedleWatch w(task, {});
    std::vector<TaskEvent> events;
    Observation o = field();
    o.tissue.grips[tool] = grip;
    watch(w, o, seconds, events);
    return w.done();
  };
  EXPECT_TRUE(met_by(1, {true, false, 1e-3, 1}));
  EXPECT_FALSE(met_by(1, {true, false, 1e-3, 1}, 0.05)) << "not yet long enough";
  EXPECT_FALSE(met_by(0, {true, false, 1e-3, 1})) << "the other hand";
  EXPECT_FALSE(met_by(1, {true, false, 1e-3, 0})) << "the other stump";
  EXPECT_FALSE(met_by(1, {true, true, 1e-3, 1})) << "through the wall";
  EXPECT_FALSE(met_by(1, {true, false, 0.2e-3, 1})) << "too gently";
  EXPECT_FALSE(met_by(1, {true, false, 3e-3, 1})) << "too hard";
}

TEST(NeedleWatch, CountsTakesDropsAndWholeStitches) {
  NeedleTask task;
  NeedleGoal pass, draw;
  pass.kind = NeedleGoal::Kind::pass;
  pass.passes = 2;
  draw.kind = NeedleGoal::Kind::draw;
  draw.passes = 2;
  draw.tail = 5e-3;
  task.goals = {pass, draw};
  task.has_tissue = true;
  SceneDescription scene;
  scene.tissue.thickness = 0.15e-3;
  scene.tissue.cut_along = Vec3::UnitX();
  NeedleWatch w(task, scene);
  std::vector<TaskEvent> events;
  Observation o = field();
  o.n_events = 6;
  const char* names[] = {"needle-taken", "needle-dropped", "tissue-taken", "tissue-taken", "wall-taken", "tissue-slipped"};
  for (std::size_t k = 0; k < 6; ++k) o.events[k].name = names[k];
  o.tissue.grips[1].pull = 2e-3;
  w.observe(o, kDt, true, events);
  o.tissue.grips[1].pull = 1e-3;
  o.n_events = 0;
  o.tissue.n_passes = 2;
  for (int k = 0; k < 2; ++k) {
    PassObservation& p = o.tissue.passes[static_cast<std::size_t>(k)];
    p.out = true;
    p.side = k;
    p.state = PassObservation::State::needle;
    p.bite_entry = p.bite_exit = 0.3e-3;
    p.depth_share = 1.0;
    p.entry_rest = p.exit_rest = Vec3(0, k == 0 ? -0.3e-3 : 0.3e-3, 0);
    p.peak_force = 4e-3;
  }
  w.observe(o, kDt, true, events);
  EXPECT_EQ(w.step(), 0) << "the needle is still in it";
  for (int k = 0; k < 2; ++k) o.tissue.passes[static_cast<std::size_t>(k)].state = PassObservation::State::thread;
  o.tissue.passes[0].arc = 9e-3;
  w.observe(o, kDt, true, events);
  EXPECT_EQ(w.step(), 1);
  o.tissue.passes[0].arc = 4e-3;
  w.observe(o, kDt, true, events);
  EXPECT_TRUE(w.done());
  const NeedleReport r = w.report();
  EXPECT_EQ(r.takes, 1);
  EXPECT_EQ(r.drops, 1);
  EXPECT_EQ(r.handling.folds, 2);
  EXPECT_EQ(needle_value(Measure::tissue_takes, r), 3.0);
  EXPECT_EQ(needle_value(Measure::wall_grasps, r), 1.0);
  EXPECT_EQ(needle_value(Measure::tissue_slips, r), 1.0);
  EXPECT_EQ(needle_value(Measure::grip_pull, r), 2e-3);
  EXPECT_EQ(r.handling.walls, 1);
  EXPECT_EQ(r.handling.slips, 1);
  EXPECT_EQ(r.handling.pull, 2e-3);
  ASSERT_EQ(r.stitches.size(), 1u);
  EXPECT_TRUE(r.lapses.empty());
  EXPECT_NEAR(needle_value(Measure::bite_widest, r), 2.0, 1e-9);
  EXPECT_NEAR(needle_value(Measure::tissue_pull, r), 4e-3, 1e-12);
  EXPECT_TRUE(std::isnan(needle_value(Measure::needle_angle, r)));
}

/// A thread of ten nodes, a millimetre apart, seen cut by cut; goals: both ends of the first two ways cut, then of the next two.
struct CutThread {
  NeedleWatch w;
  Observation o = field();
  std::vector<TaskEvent> events;
  static NeedleTask task() {
    NeedleTask task;
    for (const int passes : {2, 4}) {
      NeedleGoal cut;
      cut.kind = NeedleGoal::Kind::cut;
      cut.passes = passes;
      task.goals.push_back(cut);
    }
    return task;
  }
  CutThread() : w(task(), {}) { lengthen(10); }
  void lengthen(int n) {
    o.n_nodes = n;
    for (auto i = static_cast<int>(o.arc.size()); i < n; ++i) o.arc.push_back(1e-3 * i);
  }
  void see(const char* event = nullptr, double value = 0.0) {
    o.n_events = event == nullptr ? 0 : 1;
    if (event != nullptr) o.events[0] = {event, 2, value, "m"};
    w.observe(o, kDt, true, events);
  }
  void sew(int pass, double arc) {
    PassObservation& p = o.tissue.passes[static_cast<std::size_t>(pass)];
    o.tissue.n_passes = pass + 1;
    p.arc = -1.0;
    see();
    p.arc = arc;
    see();
  }
  void part(int edge) {
    o.parted[static_cast<std::size_t>(o.n_parted++)] = edge;
    std::sort(o.parted.begin(), o.parted.begin() + o.n_parted);
  }
  void cut(int edge, double share = 0.4) {
    part(edge);
    see("cut", 1e-3 * (edge + share));
  }
};

/// What was not looked at is not told to be whole: stitches to come, rules without gaps, a join that could not be tested.
TEST(NeedleWatch, TheLineIsTestedWhenTheTaskIsDoneAndItsJoinWasTested) {
  NeedleTask task;
  task.has_tissue = true;
  task.lapses.line_gap = 0.25;
  SceneDescription scene;
  scene.tissue.thickness = 0.1e-3;
  scene.tissue.cut_along = Vec3::UnitX();
  JoinReport join;
  join.edge = {{0.0, 0.0}, {0.5, 0.0}};
  const auto tested = [&](const NeedleTask& t, const std::optional<JoinReport>& j) { return NeedleWatch(t, scene).report(j).line_tested; };
  EXPECT_TRUE(tested(task, join));
  EXPECT_FALSE(tested(task, std::nullopt));
  JoinReport unsound = join;
  unsound.sound = false;
  EXPECT_FALSE(tested(task, unsound));
  NeedleTask unfinished = task, loose = task;
  unfinished.goals = {NeedleGoal{}};
  EXPECT_FALSE(tested(unfinished, join));
  loose.lapses.line_gap = LapseRules{}.line_gap;
  EXPECT_FALSE(tested(loose, join));
}

TEST(NeedleWatch, AnUnsoundTestOfTheJoinFindsNoLapse) {
  NeedleTask task;
  task.has_tissue = true;
  JoinReport join;
  join.overlap = 2.0 * task.lapses.overlap;
  join.thread_inside = 2.0 * task.lapses.thread_inside;
  EXPECT_EQ(NeedleWatch(task, {}).report(join).lapses.size(), 2u);
  join.sound = false;
  EXPECT_TRUE(NeedleWatch(task, {}).report(join).lapses.empty());
}

TEST(NeedleWatch, BothEndsOfAFreshSutureMustBeCut) {
  CutThread t;
  t.sew(0, 4e-3);
  t.sew(1, 5e-3);
  t.cut(7);
  EXPECT_EQ(t.w.step(), 0) << "the short end is whole";
  t.cut(2);
  EXPECT_EQ(t.w.step(), 1);
  t.part(9);
  t.lengthen(20);
  t.see("suture-fresh", 1.0);
  t.sew(2, 14e-3);
  t.sew(3, 15e-3);
  t.cut(17);
  EXPECT_EQ(t.w.step(), 1) << "the fresh suture begins behind another piece, but nobody has cut it there";
  t.cut(12, 1.0 + 1e-12);  // at a node
  EXPECT_TRUE(t.w.done());
}

TEST(NeedleWatch, AStrandThatBeginsAtACutIsCutInFront) {
  CutThread t;
  t.sew(0, 2e-3);
  t.sew(1, 3e-3);
  t.cut(1);
  t.cut(4);
  EXPECT_EQ(t.w.step(), 1);
  t.sew(2, 6e-3);
  t.sew(3, 7e-3);
  EXPECT_EQ(t.w.step(), 1) << "the needle hangs on it";
  t.cut(8);
  EXPECT_TRUE(t.w.done());
}

/// The first bite tore out and was taken anew: 4 mm are left before the first way that holds thread.
TEST(NeedleWatch, AThreadIsDrawnThoughABiteWasLostBefore) {
  for (const PassObservation::State lost : {PassObservation::State::torn, PassObservation::State::pulled_out}) {
    NeedleTask task;
    NeedleGoal draw;
    draw.kind = NeedleGoal::Kind::draw;
    draw.passes = 2;
    draw.tail = 5e-3;
    task.goals = {draw};
    NeedleWatch w(task, {});
    std::vector<TaskEvent> events;
    Observation o = field();
    o.tissue.n_passes = 3;
    for (std::size_t k = 0; k < 3; ++k) {
      o.tissue.passes[k].out = true;
      o.tissue.passes[k].state = k == 0 ? lost : PassObservation::State::thread;
      o.tissue.passes[k].arc = k == 0 ? -1.0 : 3.5e-3 + 0.5e-3 * static_cast<double>(k);
    }
    w.observe(o, kDt, true, events);
    EXPECT_TRUE(w.done());
  }
}

TEST(NeedleWatch, EndsAreCutThoughABiteWasLostBefore) {
  CutThread t;
  t.sew(0, 3e-3);
  t.o.tissue.passes[0].state = PassObservation::State::torn;
  t.o.tissue.passes[0].arc = -1.0;
  t.sew(1, 4e-3);
  t.cut(7);
  t.cut(2);
  EXPECT_EQ(t.w.step(), 0) << "only one way holds thread";
  CutThread two;
  two.sew(0, 3e-3);
  two.o.tissue.passes[0].state = PassObservation::State::torn;
  two.o.tissue.passes[0].arc = -1.0;
  two.sew(1, 4e-3);
  two.sew(2, 5e-3);
  two.cut(7);
  EXPECT_EQ(two.w.step(), 0) << "the short end is whole";
  two.cut(2);
  EXPECT_EQ(two.w.step(), 1);
}

}  // namespace needle_watch_test
}  // namespace filum
