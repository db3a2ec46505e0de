#include "training/stitch_pairs.h"

#include <gtest/gtest.h>

namespace filum {
namespace stitch_pairs_test {

using State = PassObservation::State;
using Pairs = std::vector<std::array<int, 2>>;

/// Adds a way that thread lies in.
PassObservation& bite(Observation& o, int side, State state = State::thread) {
  PassObservation& p = o.tissue.passes[static_cast<std::size_t>(o.tissue.n_passes++)];
  p = {};
  p.out = true;
  p.side = side;
  p.state = state;
  p.bite_entry = p.bite_exit = 0.3e-3;
  return p;
}

TEST(StitchPairs, ABiteAndTheNextOnTheOtherSide) {
  Observation o;
  StitchPairs pairs;
  for (const int side : {0, 1, 1, 0}) bite(o, side);
  pairs.observe(o);
  EXPECT_EQ(pairs.made(), (Pairs{{0, 1}, {2, 3}}));
}

TEST(StitchPairs, ABiteThatWasLostIsTakenAnew) {
  Observation o;
  StitchPairs pairs;
  bite(o, 0);
  bite(o, 1).state = State::torn;  // before thread lay in it
  pairs.observe(o);
  EXPECT_TRUE(pairs.made().empty());
  bite(o, 1);
  bite(o, 0);
  bite(o, 1);
  pairs.observe(o);
  EXPECT_EQ(pairs.made(), (Pairs{{0, 2}, {3, 4}})) << "and the next stitch is not shifted by it";
}

TEST(StitchPairs, AStitchStaysOneWhenItTearsOut) {
  Observation o;
  StitchPairs pairs;
  bite(o, 0);
  bite(o, 1);
  pairs.observe(o);
  o.tissue.passes[1].state = State::torn;
  bite(o, 0);
  bite(o, 1);
  pairs.observe(o);
  EXPECT_EQ(pairs.made(), (Pairs{{0, 1}, {2, 3}}));
}

TEST(StitchPairs, ABiteOnTheSameSideBeginsAnew) {
  Observation o;
  StitchPairs pairs;
  for (const int side : {0, 0, 1}) bite(o, side);
  pairs.observe(o);
  EXPECT_EQ(pairs.made(), (Pairs{{1, 2}})) << "the first stands alone";
}

TEST(StitchPairs, TheNeedleMayStillBeInTheSecondBite) {
  Observation o;
  StitchPairs pairs;
  bite(o, 0);
  bite(o, 1, State::needle);
  pairs.observe(o);
  EXPECT_TRUE(pairs.made().empty());
  EXPECT_EQ(pairs.with_needle(o.tissue), (Pairs{{0, 1}}));
  o.tissue.passes[1].state = State::pulled_out;
  pairs.observe(o);
  EXPECT_TRUE(pairs.with_needle(o.tissue).empty());
}

TEST(StitchPairs, AWayThroughBothSidesStandsByItself) {
  Observation o;
  StitchPairs pairs;
  for (int k = 0; k < 3; ++k) bite(o, k % 2).bite_exit = -0.3e-3;
  pairs.observe(o);
  EXPECT_TRUE(pairs.made().empty());
}

/// A bite whose thread was cut off and left in the wall, then a fresh suture that begins on the other side.
TEST(StitchPairs, BitesOfTwoSuturesAreNoStitch) {
  Observation o;
  StitchPairs pairs;
  o.n_nodes = 20;
  for (int i = 0; i < 20; ++i) o.arc.push_back(1e-3 * i);
  bite(o, 0).arc = 5e-3;
  pairs.observe(o);
  o.parted[static_cast<std::size_t>(o.n_parted++)] = 9;
  bite(o, 1, State::needle);
  pairs.observe(o);
  EXPECT_TRUE(pairs.with_needle(o.tissue).empty());
  o.tissue.passes[1].state = State::thread;
  o.tissue.passes[1].arc = 14e-3;
  bite(o, 0).arc = 15e-3;
  pairs.observe(o);
  EXPECT_EQ(pairs.made(), (Pairs{{1, 2}}));
  o.parted[static_cast<std::size_t>(o.n_parted++)] = 14;  // between the bites, after the stitch was made
  pairs.observe(o);
  EXPECT_EQ(pairs.made(), (Pairs{{1, 2}}));
}

}  // namespace stitch_pairs_test
}  // namespace filum
