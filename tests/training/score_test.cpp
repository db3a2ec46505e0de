#include "training/score.h"

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "training/needle_watch.h"
#include "training/task.h"

namespace filum {
namespace score_test {

TEST(Score, StitchesOutOfTurnDoNotPass) {
  const Task task = load_task(std::string(FILUM_SOURCE_DIR) + "/curricula/triangulation-120/task.yaml");
  for (const int wrong : {0, 1}) {
    Result r;
    r.finished = true;
    r.needle.emplace();
    r.needle->has_tissue = true;
    r.needle->out_of_turn = wrong;
    EXPECT_EQ(needle_value(Measure::stitch_order, *r.needle), wrong);
    score(task, false, r);
    bool told = false;
    for (const std::string& why : r.verdict) told = told || why.find("in their turn") != std::string::npos;
    EXPECT_EQ(told, wrong > 0);
  }
}

/// What the verdict says of a finished anastomosis.
std::string verdict_of(const std::function<void(NeedleReport&)>& change, const std::string& name = "anastomosis-8") {
  const Task task = load_task(std::string(FILUM_SOURCE_DIR) + "/curricula/" + name + "/task.yaml");
  Result r;
  r.finished = true;
  r.needle.emplace();
  r.needle->has_tissue = true;
  r.needle->out_of_turn = 0;
  r.needle->join = JoinReport{};
  r.needle->join->leak = 1e-6 / 60.0;
  r.needle->join->narrowing = 0.2;
  r.needle->join->patent = true;
  change(*r.needle);
  score(task, false, r);
  std::string all;
  for (const std::string& why : r.verdict) all += why + "\n";
  return all;
}

TEST(Score, AnAnastomosisNeedsAJoinThatHoldsAndLetsThrough) {
  const auto says = [](const std::string& verdict, const char* words) { return verdict.find(words) != std::string::npos; };
  const std::string good = verdict_of([](NeedleReport&) {});
  EXPECT_FALSE(says(good, "leaks") || says(good, "narrowed") || says(good, "patent") || says(good, "critical")) << good;
  EXPECT_TRUE(says(verdict_of([](NeedleReport& n) { n.join->leak = 42e-6 / 60.0; }), "the join leaks 42 ml/min, at most 2 ml/min"));
  EXPECT_TRUE(says(verdict_of([](NeedleReport& n) { n.join->narrowing = 0.7; }), "the lumen is narrowed by 70 %, at most 50 %"));
  EXPECT_TRUE(says(verdict_of([](NeedleReport& n) { n.join->patent = false; }), "not patent"));
  EXPECT_TRUE(says(verdict_of([](NeedleReport& n) { n.join.reset(); }), "could not be tested"));
  EXPECT_TRUE(says(verdict_of([](NeedleReport& n) { n.lapses.push_back({"back-wall", 2, 1.0, 170.0, "deg", true}); }), "stitch 3: back-wall, a critical failure"));
}

TEST(Score, KnotsThatWereTiedMustHoldAtTheEnd) {
  const auto tied = [](int n) {
    return verdict_of([n](NeedleReport& report) {
      report.stitches.resize(8);
      for (int k = 0; k < n; ++k) report.stitches[static_cast<std::size_t>(k)].knot = "square";
      if (n < 8) report.stitches.back().knot = "overhand";
    });
  };
  EXPECT_EQ(tied(8).find("hold"), std::string::npos) << tied(8);
  EXPECT_NE(tied(7).find("1 knot that was tied does not hold any more"), std::string::npos) << tied(7);
  EXPECT_NE(tied(6).find("2 knots that were tied do not hold any more"), std::string::npos) << tied(6);
}

/// Stitches with these knots at the end of a task; does its verdict say how many of those asked for are open?
bool told_open(const std::string& task, const std::vector<std::string>& knots, int open) {
  const std::string verdict = verdict_of(
      [&](NeedleReport& report) {
        for (const std::string& knot : knots) report.stitches.emplace_back().knot = knot;
      },
      task);
  if (open == 0) return verdict.find("not hold any more") == std::string::npos;
  return verdict.find(std::to_string(open) + (open == 1 ? " knot that was tied does" : " knots that were tied do") + " not hold any more") != std::string::npos;
}

/// Where one step ties and cuts the last of several stitches all of them count.
TEST(Score, EveryStitchIsToHoldWhereOneStepTiesSeveral) {
  for (const auto& [task, n] : {std::pair{"triangulation-120", 6}, {"posterior-wall-first", 8}, {"anastomosis-vein", 8}, {"artery-four-stitches", 4}, {"artery-two-stitches", 2}, {"stitch-knot", 1}}) {
    std::vector<std::string> knots(static_cast<std::size_t>(n), "square");
    EXPECT_TRUE(told_open(task, knots, 0)) << task;
    knots.back() = "overhand";
    EXPECT_TRUE(told_open(task, knots, 1)) << task;
    if (n < 2) continue;
    knots.front().clear();
    EXPECT_TRUE(told_open(task, knots, 2)) << task;
  }
}

/// Of a running thread only its last knot is asked for, not the first one's of its own.
TEST(Score, ARunningThreadIsHeldByItsLastTie) {
  std::vector<std::string> knots(8, "triple");
  EXPECT_TRUE(told_open("continuous-suture", knots, 0));
  knots.front() = "square";
  EXPECT_TRUE(told_open("continuous-suture", knots, 0));
  for (const char* last : {"", "granny", "other"}) EXPECT_TRUE(told_open("continuous-suture", {"triple", last, last, last, last, last, last, last}, 1)) << last;
}

/// An unfinished anastomosis with so many whole stitches, each with bites of the same size and little oblique.
Result unfinished(int stitches) {
  Result r;
  r.needle.emplace();
  r.needle->has_tissue = true;
  r.needle->thickness = 0.1e-3;
  r.needle->out_of_turn = 0;
  for (int k = 0; k < stitches; ++k) {
    Stitch& s = r.needle->stitches.emplace_back();
    s.joins = true;
    s.bite[0] = s.bite[1] = 0.2e-3;
    s.obliquity = 0.1;
  }
  score(load_task(std::string(FILUM_SOURCE_DIR) + "/curricula/anastomosis-8/task.yaml"), false, r);
  return r;
}

double points_of(const Result& r, const std::string& name) {
  for (const ScoreItem& i : r.items)
    if (i.name == name) return i.points;
  return -1.0;
}

TEST(Score, AnUnfinishedAnastomosisEarnsWhatWasSewnAndNothingForFewFaults) {
  const Result six = unfinished(6), none = unfinished(0);
  EXPECT_NEAR(points_of(six, "stitches"), 20.0 / 3.0, 1e-9) << "20 from eight, none at five";
  EXPECT_EQ(points_of(six, "bite-inequality"), 10.0);
  EXPECT_EQ(points_of(six, "obliquity"), 5.0);
  for (const char* fault : {"stitch-order", "lapses", "tissue-pull", "needle-drops", "time"}) EXPECT_EQ(points_of(six, fault), 0.0) << fault;
  EXPECT_EQ(points_of(unfinished(5), "stitches"), 0.0);
  EXPECT_EQ(none.total, 0.0);
  EXPECT_FALSE(six.passed);
  EXPECT_EQ(six.verdict.front(), "not all steps were done");
}

/// Whatever its points, so also when they are all there.
TEST(Score, WhatIsNotFinishedDoesNotPass) {
  Task task = load_task(std::string(FILUM_SOURCE_DIR) + "/curricula/artery-stitch/task.yaml");
  task.pass_points = 0.0;
  Result r;
  r.needle.emplace();
  r.needle->has_tissue = true;
  r.needle->stitches.emplace_back().joins = true;
  score(task, false, r);
  EXPECT_GT(r.total, 0.0);
  EXPECT_FALSE(r.passed);
}

}  // namespace score_test
}  // namespace filum
