#include "training/laurent.h"

#include <gtest/gtest.h>

#include <limits>

namespace filum {
namespace laurent_test {

TEST(Laurent, AddsMultipliesAndDividesExactly) {
  const Laurent a(-2, {1, 0, -3}), b(1, {1, 1});
  const Laurent product = a * b;
  EXPECT_EQ(product, Laurent(-1, {1, 1, -3, -3}));
  EXPECT_EQ(product.divided(b), a);
  EXPECT_EQ(product.divided(Laurent(-5, {-1, -1})), Laurent(4, {-1, 0, 3}));
  Laurent sum = a;
  sum += Laurent(-2, {-1, 0, 3});
  EXPECT_TRUE(sum.zero());
  EXPECT_EQ(sum, Laurent());
}

TEST(Laurent, IsKeptWithoutOuterZeros) {
  EXPECT_EQ(Laurent(-1, {0, 2, 0}), Laurent(0, {2}));
  EXPECT_EQ(Laurent(0, {2}).low(), 0);
  EXPECT_EQ(Laurent(3, {0, 0}).at(3), 0);
}

TEST(Laurent, MirrorsShiftsAndEvaluates) {
  const Laurent a(1, {1, 0, 1, -1});  // t + t^3 - t^4
  EXPECT_EQ(a.mirrored(), Laurent(-4, {-1, 1, 0, 1}));
  EXPECT_EQ(a.mirrored().mirrored(), a);
  EXPECT_EQ(a.shifted(-1), Laurent(0, {1, 0, 1, -1}));
  EXPECT_EQ(a.at_minus_one(), -3);
}

/// As laurent.h promises, also at the one number whose minus does not fit: there UBSan stops a plain minus, and the text had two signs.
TEST(Laurent, TheLeastCoefficientWrapsToItself) {
  constexpr std::int64_t least = std::numeric_limits<std::int64_t>::min();
  const Laurent a(1, {least}), b(0, {1, 1});
  EXPECT_EQ(a.at_minus_one(), least);
  EXPECT_EQ((a * b).divided(b), a);
  EXPECT_EQ(a.text("t"), "-9223372036854775808 t");
}

TEST(Laurent, Text) {
  EXPECT_EQ(Laurent().text("t"), "0");
  EXPECT_EQ(Laurent(-3, {-1, 1, -1, 3, -1}).text("t"), "-t^-3 + t^-2 - t^-1 + 3 - t");
  EXPECT_EQ(Laurent(0, {-1, 2, -12}).text("A"), "-1 + 2 A - 12 A^2");
}

}  // namespace laurent_test
}  // namespace filum
