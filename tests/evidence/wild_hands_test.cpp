#include "evidence/wild_hands.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "collision/segment_distance.h"
#include "evidence/sewn_bench.h"
#include "world/state.h"
#include "world/task_folder.h"

namespace filum {
namespace wild_hands_test {

constexpr int kSeeds = 20;

/// Scene time is short, hands are fast: at 0.5 m/s a tool crosses the field thirty times a second.
void survive(const char* task, int steps) {
  World world(load_model(FILUM_SOURCE_DIR, task));
  const State first = world.state();
  double fastest = 0.0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const WildRun run = run_wild(world, first, seed, steps);
    EXPECT_EQ(run.fault, "") << task << ", seed " << seed << ", step " << run.steps;
    EXPECT_EQ(run.steps, static_cast<std::uint64_t>(steps));
    fastest = std::max(fastest, run.fastest);
  }
  testing::Test::RecordProperty("fastest", std::to_string(fastest));
}

/// One of every kind of scene for longer, all others for as long as it takes a hand to come to what there is.
const std::map<std::string, int> kLonger = {{"knot-square", 60}, {"needle-loading", 80}, {"card-stitches", 60}, {"vessel-stitch", 60}, {"anastomosis-vein", 40}, {"grasp-transfer", 100}, {"press-to-target", 30}};

TEST(WildHands, ThreadOnAPost) { survive("knot-square", kLonger.at("knot-square")); }
TEST(WildHands, Needle) { survive("needle-loading", kLonger.at("needle-loading")); }
TEST(WildHands, Card) { survive("card-stitches", kLonger.at("card-stitches")); }
TEST(WildHands, Vessel) { survive("vessel-stitch", kLonger.at("vessel-stitch")); }
TEST(WildHands, Vein) { survive("anastomosis-vein", kLonger.at("anastomosis-vein")); }
TEST(WildHands, Objects) { survive("grasp-transfer", kLonger.at("grasp-transfer")); }
TEST(WildHands, Brain) { survive("press-to-target", kLonger.at("press-to-target")); }

TEST(WildHands, EveryOtherTask) {
  int tried = 0;
  for (const auto& [task, folder] : task_folders(FILUM_SOURCE_DIR)) {
    if (kLonger.contains(task)) continue;
    survive(task.c_str(), 20);
    ++tried;
  }
  EXPECT_GT(tried, 15);
}

/// Thread is dragged along out of a track's reach within the wall, at 0.1 m/s, and led out of it (else: still there in step 221).
TEST(WildHands, ThreadThatStraysOutOfATrackIsLedOut) {
  const auto [model, sewn] = sewn_stumps(load_model(FILUM_SOURCE_DIR, "anastomosis-8"), 1);
  World world(model);
  const WildRun run = run_wild(world, sewn, 6, 240);
  EXPECT_EQ(run.fault, "");
  EXPECT_GT(run.buried, 1) << "nothing strayed";
}

/// Thread is caught between two tools that hands go on driving into each other: held where they were, they press it no further (else: through itself in step 505).
TEST(WildHands, ToolsDoNotPressStrandsThroughEachOther) {
  World world(load_model(FILUM_SOURCE_DIR, "end-to-side"));
  std::vector<std::uint64_t> told;
  const WildRun run = run_wild(world, world.state(), 3, 520, [&](const WildRun& r) { told.push_back(r.steps); });
  EXPECT_EQ(run.fault, "");
  EXPECT_EQ(told, std::vector<std::uint64_t>{kWildTold});
  EXPECT_LT(run.deepest, 0.5);
}

/// The same without a needle (else: 0.87 into each other).
TEST(WildHands, ToolsDoNotPressABareThreadThroughItself) {
  World world(load_model(FILUM_SOURCE_DIR, "knot-two-forceps"));
  const WildRun run = run_wild(world, world.state(), 331, 300);
  EXPECT_EQ(run.fault, "");
  EXPECT_LT(run.deepest, 0.5);
}

/// The thread's edges are numbered anew as they are halved and joined; the gap that is told is that of the edges the contacts knew.
TEST(WildHands, StrandsAreNotSaidToBeNearerThanAnyTwoEdgesAre) {
  World world(load_model(FILUM_SOURCE_DIR, "knot-throw"));
  WildHands hands(34, world.description());  // seen to fail where the gap was measured after nodes are merged
  int renumbered = 0;
  double last = 1.0;  // [m], edges that were merged at the end of a step were still there when it was measured
  for (int k = 0; k < 80; ++k) {
    const int before = world.state().thread.n;
    world.step(hands.next(world.observation()));
    const RodState& t = world.state().thread;
    renumbered += t.n != before ? 1 : 0;
    double least = 1.0;
    for (int i = 0; i + 3 < t.n; ++i)
      for (int j = i + 2; j + 1 < t.n; ++j)
        if (t.alive[i] != 0 && t.alive[j] != 0) least = std::min(least, closest_points(t.x.col(i), t.x.col(i + 1), t.x.col(j), t.x.col(j + 1)).distance);
    ASSERT_GE(world.observation().min_gap, std::min(least, last) - 2.0 * world.observation().radius - 1e-9) << "step " << k;
    last = least;
  }
  EXPECT_GT(renumbered, 5);
}

TEST(WildHands, SameSeedSameHandsAndTheyHit) {
  const auto model = load_model(FILUM_SOURCE_DIR, "needle-loading");
  World world(model), other(model);
  WildHands hands(3, world.description()), again(3, world.description());
  double hardest = 0.0;
  for (int k = 0; k < 150; ++k) {
    world.step(hands.next(world.observation()));
    other.step(again.next(other.observation()));
    for (int i = 0; i < world.observation().n_tools; ++i) hardest = std::max(hardest, world.observation().tools[static_cast<std::size_t>(i)].f_T_W.norm());
  }
  EXPECT_EQ(world.observation().state_hash, other.observation().state_hash);
  EXPECT_GT(hardest, 1e-4) << "hands that touch nothing test nothing";
}

}  // namespace wild_hands_test
}  // namespace filum
