#include "base/rng.h"

#include <gtest/gtest.h>

#include <array>

namespace filum {
namespace rng_test {

TEST(Rng, EngineIsTheOneOfTheStandard) {
  Rng rng(5489);  // the C++ standard fixes the 10,000th value of the default-seeded mt19937_64
  std::uint64_t last = 0;
  for (int i = 0; i < 10000; ++i) last = rng.bits();
  EXPECT_EQ(last, 9981545732273789042ull);
}

TEST(Rng, SameSeedSameNumbersOtherSeedOthers) {
  Rng a(11);
  Rng b(11);
  Rng c(12);
  bool differs = false;
  for (int i = 0; i < 100; ++i) {
    const double x = a.normal();
    EXPECT_EQ(x, b.normal());
    differs = differs || x != c.normal();
  }
  EXPECT_TRUE(differs);
}

TEST(Rng, UniformFillsItsIntervalEvenly) {
  Rng rng(1);
  std::array<int, 10> bins{};
  for (int i = 0; i < 100000; ++i) {
    const double x = rng.uniform(2.0, 4.0);
    ASSERT_GE(x, 2.0);
    ASSERT_LT(x, 4.0);
    ++bins[static_cast<std::size_t>((x - 2.0) * 5.0)];
  }
  for (const int n : bins) EXPECT_NEAR(n, 10000, 500);  // 5 standard deviations
}

TEST(Rng, NormalHasTheMomentsOfANormal) {
  Rng rng(2);
  const int n = 200000;
  double sum = 0, square = 0, fourth = 0;
  for (int i = 0; i < n; ++i) {
    const double x = rng.normal();
    sum += x;
    square += x * x;
    fourth += x * x * x * x;
  }
  EXPECT_NEAR(sum / n, 0.0, 0.012);
  EXPECT_NEAR(square / n, 1.0, 0.016);
  EXPECT_NEAR(fourth / n, 3.0, 0.11);
}

TEST(Rng, BelowIsInRangeAndReachesAll) {
  Rng rng(3);
  std::array<int, 7> seen{};
  for (int i = 0; i < 7000; ++i) ++seen.at(rng.below(7));
  for (const int n : seen) EXPECT_NEAR(n, 1000, 150);
  EXPECT_EQ(rng.below(1), 0u);
}

TEST(Rng, DirectionsAndRotationsAreUnitAndUnbiased) {
  Rng rng(4);
  Vec3 mean = Vec3::Zero();
  Vec3 mean_rotated = Vec3::Zero();
  const int n = 20000;
  for (int i = 0; i < n; ++i) {
    const Vec3 d = rng.direction();
    const Quat q = rng.rotation();
    ASSERT_NEAR(d.norm(), 1.0, 1e-14);
    ASSERT_NEAR(q.norm(), 1.0, 1e-14);
    mean += d / n;
    mean_rotated += q * Vec3::UnitX() / n;
  }
  EXPECT_LT(mean.norm(), 0.035);
  EXPECT_LT(mean_rotated.norm(), 0.035);
}

}  // namespace rng_test
}  // namespace filum
