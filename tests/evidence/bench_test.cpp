#include "evidence/bench.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "evidence/sewn_bench.h"

namespace filum {
namespace bench_test {

DrivenTask no_task(const std::string& task) {
  throw InputError("test", "task", task, "none");
}

TEST(Bench, TimesAreOrderedAndTheReferenceIsTimedBesideThem) {
  const auto results = run_benches({"scaling-50"}, no_task);
  ASSERT_EQ(results.size(), 1u);
  const BenchResult& r = results[0];
  EXPECT_EQ(r.nodes, 50);
  EXPECT_EQ(r.steps, 500);
  EXPECT_GT(r.p50_ms, 0.0);
  EXPECT_LE(r.p50_ms, r.p99_ms);
  EXPECT_LE(r.p99_ms, r.max_ms);
  EXPECT_GT(r.real_time_factor, 0.0);
  EXPECT_FALSE(r.reference_name.empty());
  EXPECT_GT(r.reference_p50_ms, 0.0);
}

TEST(Bench, TheStagesOfAStepAddUpToIt) {
  const BenchResult r = run_benches({"rope-50"}, no_task)[0];
  EXPECT_GT(r.contacts, 20);
  double sum = 0.0;
  bool solves = false;
  for (const auto& [name, ms] : r.stages) {
    sum += ms;
    solves = solves || (name == "linear system" && ms > 0.0);
  }
  EXPECT_TRUE(solves);
  EXPECT_GT(sum, 0.5 * r.p50_ms);  // medians of parts do not add up exactly
  EXPECT_LT(sum, 1.5 * r.p50_ms);
}

TEST(Bench, ATaskIsTimedUntilItsHandsAreDone) {
  int steps = 0;
  const TaskOpener opener = [&](const std::string& task) {
    EXPECT_EQ(task, "knot-square");
    DrivenTask driven;
    driven.model = load_model(FILUM_SOURCE_DIR, task);
    driven.inputs = [&](const World&) {
      ++steps;
      return Inputs();
    };
    driven.over = [&] { return steps > 20; };
    return driven;
  };
  const BenchResult r = run_benches({"task-knot-square"}, opener)[0];
  EXPECT_EQ(r.steps, 20);
  EXPECT_GT(r.nodes, 10);
  bool observes = false;
  for (const auto& [name, ms] : r.stages) observes = observes || name == "observation";
  EXPECT_TRUE(observes);
}

/// Sewn by construction: each track holds the thread where it was laid, still does half a second later, and nothing was torn.
TEST(Bench, EightStitchesByConstructionHold) {
  const auto [model, state] = sewn_stumps(load_model(FILUM_SOURCE_DIR, "vessel-stitch"), 8);
  World world(model);
  world.restore(state);
  ASSERT_EQ(world.state().tissue.tracks.n, 16);
  for (int k = 0; k < 100; ++k) world.step(Inputs{});
  const State& s = world.state();
  for (int k = 0; k < 16; ++k) {
    const NeedleTrack& t = s.tissue.tracks.tracks[static_cast<std::size_t>(k)];
    EXPECT_EQ(t.n, 3) << k;
    EXPECT_EQ(t.ended, 0) << k;
    EXPECT_EQ(t.torn, 0.0) << k;
    const Vec3 entry = world.observation().tissue.passes[static_cast<std::size_t>(k)].entry_W;
    EXPECT_LT((s.thread.x.leftCols(s.thread.n).colwise() - entry).colwise().norm().minCoeff(), 0.2e-3) << "thread runs through it, " << k;
  }
  EXPECT_LT(s.thread.v.leftCols(s.thread.n).colwise().norm().maxCoeff(), 1.0);
}

TEST(Bench, ANameStandsForThoseThatBeginWithIt) {
  std::size_t scaling = 0;
  for (const std::string& name : bench_names()) scaling += name.starts_with("scaling-") ? 1 : 0;
  EXPECT_EQ(run_benches({"scaling"}, no_task).size(), scaling);
}

TEST(Bench, AnUnknownNameIsRefused) {
  EXPECT_THROW(run_benches({"scal"}, no_task), InputError);
}

TEST(Bench, AMissingTaskIsToldByItsOpener) {
  EXPECT_THROW(run_benches({"task-knot-square"}, no_task), InputError);
}

TEST(Bench, TheMachineIsNamed) {
  EXPECT_NE(machine_text().find(" cores"), std::string::npos);
}

}  // namespace bench_test
}  // namespace filum
