#include "evidence/wild_hands.h"

#include <gtest/gtest.h>

#include "world/state.h"

namespace filum {
namespace {

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

TEST(WildHands, ThreadOnAPost) { survive("knot-square", 60); }
TEST(WildHands, Needle) { survive("needle-loading", 80); }
TEST(WildHands, Card) { survive("card-stitches", 80); }
TEST(WildHands, Vessel) { survive("vessel-stitch", 80); }
TEST(WildHands, Objects) { survive("grasp-transfer", 100); }
TEST(WildHands, Brain) { survive("press-to-target", 40); }

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

}  // namespace
}  // namespace filum
