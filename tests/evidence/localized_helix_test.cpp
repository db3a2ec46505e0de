#include "evidence/localized_helix.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace filum {
namespace localized_helix_test {

constexpr double kPi = std::numbers::pi;

struct Known {
  HelixRod rod;
  double moment, tension, degrees, width;
};

// The case of PyElastica, as its authors state it (98.5415 B/L, 2900.9932 B/L^2), and that of Bergou et al. 2008.
class HelixTheory : public testing::TestWithParam<Known> {};

TEST_P(HelixTheory, GivesThePublishedFigures) {
  const auto& [rod, moment, tension, degrees, width] = GetParam();
  const LocalizedHelix h = localized_helix_theory(rod);
  EXPECT_NEAR(h.moment / moment, 1.0, 1e-6);
  EXPECT_NEAR(h.tension / tension, 1.0, 2e-6);
  EXPECT_NEAR(h.angle * 180.0 / kPi, degrees, 1e-3);
  EXPECT_NEAR(h.width / width, 1.0, 2e-6);
}

TEST_P(HelixTheory, FulfilsItsOwnEquations) {
  const HelixRod& r = GetParam().rod;
  const LocalizedHelix h = localized_helix_theory(r);
  const double m = h.moment / std::sqrt(r.B * h.tension);
  EXPECT_NEAR(4.0 * std::sqrt(r.B / h.tension) * std::sqrt(1.0 - 0.25 * m * m), r.shortening, 1e-9);
  EXPECT_NEAR(h.moment * r.length / r.C + 4.0 * std::acos(0.5 * m), 2.0 * kPi * r.turns, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Published, HelixTheory,
                         testing::Values(Known{{1.345, 0.789, 100.0, 27.0, 3.0}, 98.5415 * 1.345 / 100.0, 2900.9932 * 1.345 / 1e4, 47.6515, 4.59613},
                                         Known{{1.345, 0.789, 9.29, 27.0, 0.3}, 14.25202, 46.9885, 52.629, 0.381654}));

TEST(LocalizedHelix, ACoarseRodIsFurtherOff) {
  const HelixRod rod{1.345, 0.789, 9.29, 27.0, 0.3};
  const HelixFound coarse = localized_helix_found(rod, 60), fine = localized_helix_found(rod, 120);
  EXPECT_GT(coarse.envelope_error, 2.0 * fine.envelope_error);
  EXPECT_LT(fine.envelope_error, 0.06);
}

}  // namespace localized_helix_test
}  // namespace filum
