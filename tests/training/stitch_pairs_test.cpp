#include "training/stitch_pairs.h"

#include <gtest/gtest.h>

namespace filum {
namespace stitch_pairs_test {

using State = PassObservation::State;
using Pairs = std::vector<std::array<int, 2>>;

/// Adds a way that thread lies in.
PassObservation& bite(TissueObservation& t, int side, State state = State::thread) {
  PassObservation& p = t.passes[static_cast<std::size_t>(t.n_passes++)];
  p = {};
  p.out = true;
  p.side = side;
  p.state = state;
  p.bite_entry = p.bite_exit = 0.3e-3;
  return p;
}

TEST(StitchPairs, ABiteAndTheNextOnTheOtherSide) {
  TissueObservation t;
  StitchPairs pairs;
  for (const int side : {0, 1, 1, 0}) bite(t, side);
  pairs.observe(t);
  EXPECT_EQ(pairs.made(), (Pairs{{0, 1}, {2, 3}}));
}

TEST(StitchPairs, ABiteThatWasLostIsTakenAnew) {
  TissueObservation t;
  StitchPairs pairs;
  bite(t, 0);
  bite(t, 1).state = State::torn;  // before thread lay in it
  pairs.observe(t);
  EXPECT_TRUE(pairs.made().empty());
  bite(t, 1);
  bite(t, 0);
  bite(t, 1);
  pairs.observe(t);
  EXPECT_EQ(pairs.made(), (Pairs{{0, 2}, {3, 4}})) << "and the next stitch is not shifted by it";
}

TEST(StitchPairs, AStitchStaysOneWhenItTearsOut) {
  TissueObservation t;
  StitchPairs pairs;
  bite(t, 0);
  bite(t, 1);
  pairs.observe(t);
  t.passes[1].state = State::torn;
  bite(t, 0);
  bite(t, 1);
  pairs.observe(t);
  EXPECT_EQ(pairs.made(), (Pairs{{0, 1}, {2, 3}}));
}

TEST(StitchPairs, ABiteOnTheSameSideBeginsAnew) {
  TissueObservation t;
  StitchPairs pairs;
  for (const int side : {0, 0, 1}) bite(t, side);
  pairs.observe(t);
  EXPECT_EQ(pairs.made(), (Pairs{{1, 2}})) << "the first stands alone";
}

TEST(StitchPairs, TheNeedleMayStillBeInTheSecondBite) {
  TissueObservation t;
  StitchPairs pairs;
  bite(t, 0);
  bite(t, 1, State::needle);
  pairs.observe(t);
  EXPECT_TRUE(pairs.made().empty());
  EXPECT_EQ(pairs.with_needle(t), (Pairs{{0, 1}}));
  t.passes[1].state = State::pulled_out;
  pairs.observe(t);
  EXPECT_TRUE(pairs.with_needle(t).empty());
}

TEST(StitchPairs, AWayThroughBothSidesStandsByItself) {
  TissueObservation t;
  StitchPairs pairs;
  for (int k = 0; k < 3; ++k) bite(t, k % 2).bite_exit = -0.3e-3;
  pairs.observe(t);
  EXPECT_TRUE(pairs.made().empty());
}

}  // namespace stitch_pairs_test
}  // namespace filum
