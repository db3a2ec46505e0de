#include "training/lab_watch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "training/task_session.h"

namespace filum {
namespace lab_watch_test {

constexpr double kDt = 2e-3;  // [s]

Task lab_task(TaskStep step) {
  Task task;
  task.laboratory = true;
  task.steps = {std::move(step)};
  return task;
}

SceneDescription scene() {
  SceneDescription s;
  s.n_tools = 1;
  s.n_pellets = 1;
  s.pellets[0] = {"object", 0.4e-3, 0.05, 0.4};
  s.floor_height = 0.0;
  return s;
}

Observation seen(double time, const Vec3& tip) {
  Observation o;
  o.time = time;
  o.n_tools = 1;
  o.tools[0].X_WT.p = tip;
  o.tools[0].input_valid = true;
  return o;
}

int count(const std::vector<TaskEvent>& events, const std::string& name) {
  int n = 0;
  for (const TaskEvent& e : events) n += e.name == name ? 1 : 0;
  return n;
}

TEST(LabWatch, HoldMeasuresTheDistanceFromTheTarget) {
  TaskStep step;
  step.kind = StepKind::hold;
  step.within = 0.2e-3;
  step.seconds = 10.0;
  LabWatch watch(lab_task(step), scene());
  std::vector<TaskEvent> events;
  for (int k = 0; k < 8000 && !watch.done(); ++k) {
    const double t = kDt * k;
    // Far away for a second, then a circle of 0.1 mm about the target.
    const Vec3 tip = t < 1.0 ? Vec3(5e-3, 0, 0) : Vec3(0.1e-3 * std::cos(t), 0.1e-3 * std::sin(t), 0.0);
    watch.observe(seen(t, tip), kDt, true, events);
  }
  EXPECT_TRUE(watch.done());
  EXPECT_NEAR(watch.target_error(), 0.1e-3, 1e-9);
  EXPECT_NEAR(watch.target_longest(), 0.1e-3, 1e-9);
  EXPECT_EQ(watch.on_target(), 1.0);
  EXPECT_EQ(count(events, "hold-begun"), 1);
  EXPECT_EQ(count(events, "hold-done"), 1);
  EXPECT_EQ(count(events, "target-error"), 10);
  EXPECT_NEAR(events.front().time, 1.0, 1e-9);
}

TEST(LabWatch, LeavingTheTargetIsSaidAndTheClockRunsOn) {
  TaskStep step;
  step.kind = StepKind::hold;
  step.within = 0.2e-3;
  step.seconds = 4.0;
  LabWatch watch(lab_task(step), scene());
  std::vector<TaskEvent> events;
  for (int k = 0; k <= 2000; ++k) {
    const double t = kDt * k;
    watch.observe(seen(t, t >= 1.0 && t < 2.0 ? Vec3(1e-3, 0, 0) : Vec3(Vec3::Zero())), kDt, true, events);
  }
  EXPECT_TRUE(watch.done());
  EXPECT_EQ(count(events, "target-left"), 1);
  EXPECT_NEAR(watch.on_target(), 0.75, 1e-3);
  EXPECT_NEAR(watch.target_error(), 0.5e-3, 1e-6);
}

TEST(LabWatch, AnUnscoredStretchCountsForNothing) {
  TaskStep step;
  step.kind = StepKind::hold;
  step.within = 0.2e-3;
  step.seconds = 4.0;
  LabWatch watch(lab_task(step), scene());
  std::vector<TaskEvent> events;
  for (int k = 0; k < 1000; ++k) watch.observe(seen(kDt * k, Vec3::Zero()), kDt, false, events);
  EXPECT_TRUE(events.empty());
  EXPECT_TRUE(std::isnan(watch.target_error()));
}

TaskStep square() {
  TaskStep step;
  step.kind = StepKind::follow;
  step.within = 0.1e-3;
  step.path.resize(3, 5);
  step.path << 0, 1e-3, 1e-3, 0, 0, 0, 0, 1e-3, 1e-3, 0, 0, 0, 0, 0, 0;
  return step;
}

TEST(LabWatch, FollowMeasuresTheDistanceFromTheLineAndCannotTakeAShortCut) {
  LabWatch watch(lab_task(square()), scene());
  std::vector<TaskEvent> events;
  double t = 0.0;
  const auto move = [&](const Vec3& a, const Vec3& b) {
    for (int k = 0; k < 500; ++k, t += kDt) watch.observe(seen(t, a + (b - a) * (k / 499.0)), kDt, true, events);
  };
  const Vec3 off(0, 0, 20e-6);  // beside the line all the way
  move(off, Vec3(1e-3, 0, 0) + off);
  move(Vec3(1e-3, 0, 0) + off, Vec3(1e-3, 1e-3, 0) + off);
  EXPECT_FALSE(watch.done()) << "the start, which is also the end, was near at the beginning";
  move(Vec3(1e-3, 1e-3, 0) + off, Vec3(0, 1e-3, 0) + off);
  move(Vec3(0, 1e-3, 0) + off, off);
  EXPECT_TRUE(watch.done());
  EXPECT_NEAR(watch.target_error(), 20e-6, 1e-7);
  EXPECT_EQ(count(events, "trace-done"), 1);
}

TEST(LabWatch, NearestPointOfAPathIsWithinTheStretchAskedFor) {
  const Points path = square().path;
  EXPECT_NEAR(length_of(path), 4e-3, 1e-15);
  const PathPoint all = nearest_on_path(path, Vec3(0.2e-3, 0.1e-3, 0), 0.0, 4e-3);
  EXPECT_NEAR(all.arc, 0.2e-3, 1e-12);
  EXPECT_NEAR(all.distance, 0.1e-3, 1e-12);
  const PathPoint late = nearest_on_path(path, Vec3(0.2e-3, 0.1e-3, 0), 2.5e-3, 4e-3);
  EXPECT_NEAR(late.arc, 3.9e-3, 1e-12);
  EXPECT_NEAR(late.distance, 0.2e-3, 1e-12);
}

TEST(LabWatch, AnObjectIsPlacedWhenItLiesLooseOnTheSpot) {
  TaskStep step;
  step.kind = StepKind::place;
  step.at = Vec3(3e-3, 0, 0);
  step.within = 0.5e-3;
  LabWatch watch(lab_task(step), scene());
  std::vector<TaskEvent> events;
  Observation o = seen(0.0, Vec3::Zero());
  o.n_pellets = 1;
  o.tools[0].grip_force = 0.1;
  o.pellets[0] = {Vec3(3.3e-3, 0, 0.4e-3), 0, false};
  for (int k = 0; k < 100; ++k) watch.observe(o, kDt, true, events);
  EXPECT_FALSE(watch.done()) << "still held";
  EXPECT_NEAR(watch.force_share(), 0.25, 1e-12);
  EXPECT_NEAR(watch.force_excess(), 0.05, 1e-12);
  o.pellets[0].holder = -1;
  watch.observe(o, kDt, true, events);
  EXPECT_TRUE(watch.done());
  EXPECT_NEAR(watch.target_error(), 0.3e-3, 1e-12);
}

TEST(LabWatch, ABrokenObjectIsLostAndCounted) {
  TaskStep step;
  step.kind = StepKind::place;
  LabWatch watch(lab_task(step), scene());
  std::vector<TaskEvent> events;
  Observation o = seen(0.0, Vec3::Zero());
  o.n_pellets = 1;
  o.pellets[0] = {Vec3(3.3e-3, 0, 0.4e-3), 0, true};
  watch.observe(o, kDt, true, events);
  EXPECT_EQ(watch.broken(), 1);
  EXPECT_EQ(count(events, "object-lost"), 1);
  EXPECT_EQ(watch.force_share(), 1.0);
}

TEST(LabWatch, TheTasksOfTheLaboratoryAreReadAndScored) {
  for (const char* name : {"tip-hold", "trace", "grasp-transfer"}) {
    const Task task = load_task(std::string(FILUM_SOURCE_DIR) + "/curricula/research/" + name + "/task.yaml");
    EXPECT_TRUE(task.laboratory);
    EXPECT_EQ(task.max_total(), 100.0) << name;
    SceneDescription s = scene();
    TaskSession session(task, s);
    const Result r = session.finish();
    EXPECT_FALSE(r.finished);
    EXPECT_FALSE(r.passed);
    EXPECT_EQ(r.total, 0.0) << name;
  }
}

TEST(LabWatch, AHoldGivenUpEarlyGetsNoPoints) {
  const Task task = load_task(std::string(FILUM_SOURCE_DIR) + "/curricula/research/tip-hold/task.yaml");
  SceneDescription s = scene();
  s.dt = kDt;
  TaskSession session(task, s);
  for (int k = 0; k < 2500; ++k) session.observe(seen(kDt * k, Vec3(0, 0, 5e-3)));
  const Result r = session.finish();
  EXPECT_FALSE(r.finished);
  EXPECT_EQ(r.total, 0.0);
  EXPECT_NE(r.items.front().why.find("not all steps were done"), std::string::npos) << r.items.front().why;
}

}  // namespace lab_watch_test
}  // namespace filum
