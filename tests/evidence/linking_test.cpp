#include "evidence/linking.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace filum {
namespace linking_test {

constexpr double kPi = std::numbers::pi;

/// Corners of a curve on a torus that goes round `long_way` times while it winds `short_way` times.
Points torus_curve(int corners, int long_way, int short_way, double start) {
  Points p(3, corners);
  for (int i = 0; i < corners; ++i) {
    const double a = 2.0 * kPi * i / corners, u = long_way * a, v = short_way * a + start, r = 2.0 + 0.6 * std::cos(v);
    p.col(i) = Vec3(r * std::cos(u), r * std::sin(u), 0.6 * std::sin(v));
  }
  return p;
}

TEST(Linking, TwoStrandsOfATorusAreLinkedAsOftenAsTheyWind) {
  for (int turns : {-3, -1, 0, 1, 2, 5}) {
    const Points a = torus_curve(60, 1, turns, 0.0), b = torus_curve(73, 1, turns, kPi);
    EXPECT_NEAR(std::abs(linking_number(a, b)), std::abs(turns), 1e-12);
    EXPECT_NEAR(linking_number(a, b), linking_number(b, a), 1e-12);
    EXPECT_NEAR(linking_number(a, b) * turns, linking_number(torus_curve(60, 1, 1, 0.0), torus_curve(60, 1, 1, kPi)) * turns * turns, 1e-10);
  }
}

TEST(Linking, FarLoopsAreNotLinkedAndMirrorImagesTurnTheSign) {
  const Points a = torus_curve(40, 1, 2, 0.0), b = torus_curve(40, 1, 2, kPi);
  EXPECT_NEAR(linking_number(a, b.colwise() + Vec3(9, 0, 0)), 0.0, 1e-12);
  const Vec3 mirror(1, 1, -1);
  EXPECT_NEAR(linking_number(mirror.asDiagonal() * a, mirror.asDiagonal() * b), -linking_number(a, b), 1e-12);
}

/// One turn of a helix of radius r and pitch p: Wr = 1 - p/sqrt(p^2 + (2 pi r)^2) for each turn of a long one (Fuller 1978).
TEST(Linking, WritheOfALongHelix) {
  constexpr int kTurns = 40, kCorners = 40 * kTurns;
  const double r = 0.3, pitch = 2.0;
  Points p(3, kCorners + 3);
  for (int i = 0; i <= kCorners; ++i) {
    const double a = 2.0 * kPi * kTurns * i / kCorners;
    p.col(i + 1) = Vec3(r * std::cos(a), r * std::sin(a), pitch * a / (2.0 * kPi));
  }
  p.col(0) = p.col(1) - Vec3(0, 0, 1e4);
  p.col(kCorners + 2) = p.col(kCorners + 1) + Vec3(0, 0, 1e4);
  const double expected = kTurns * (1.0 - pitch / std::hypot(pitch, 2.0 * kPi * r));
  EXPECT_NEAR(writhe(p) / expected, 1.0, 0.01);
}

TEST(Linking, APlaneCurveDoesNotWrithe) {
  Points p(3, 30);
  for (int i = 0; i < 30; ++i) p.col(i) = Vec3(i, std::sin(0.5 * i), 0.0);
  EXPECT_NEAR(writhe(p), 0.0, 1e-12);
}

}  // namespace linking_test
}  // namespace filum
