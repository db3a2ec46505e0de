#include "evidence/plectoneme.h"

#include <gtest/gtest.h>

#include <numbers>

namespace filum {
namespace plectoneme_test {

/// The table in Clauvelin et al. 2009, as computed anew from their formulas: angle [deg], F R^2/B, M R/B.
TEST(Plectoneme, LawOfThePly) {
  const double table[6][3] = {{10, 0.001422, 0.010975}, {12, 0.002980, 0.019246}, {15, 0.007425, 0.038675},
                              {18, 0.015831, 0.069379}, {20, 0.024705, 0.098156}, {25, 0.065578, 0.212855}};
  for (const auto& row : table) {
    const double a = row[0] * std::numbers::pi / 180.0;
    EXPECT_NEAR(ply_tension(a), row[1], 2e-6) << row[0];
    EXPECT_NEAR(ply_moment(a), row[2], 2e-6) << row[0];
  }
}

// The forces of a whole plectoneme: `filum validate plectoneme`, run by validation_test.
TEST(Plectoneme, KeepsTheTurnsItWasGivenAsTwistAndWrithe) {
  Plectoneme p(120);
  ASSERT_NEAR(p.linking(), 0.0, 1e-3);
  p.wind(5.0);
  EXPECT_NEAR(p.linking(), 5.0, 1e-3);
  EXPECT_LT(p.farthest(), 0.1);  // a passage would lose two turns
  EXPECT_GT(p.ply().contacts, 5);
}

}  // namespace plectoneme_test
}  // namespace filum
