// The trainer's wall elements on an inflated tube against Lame's closed form and the reduced model's quadrature.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "reconcile/full_solver.h"

namespace filum::reconcile {
namespace {

const TubeWall kTube{0.7e-3, 1.0e-3};

TEST(FullTube, LinearPartIsLames) {
  const double coarse = tube_linear_factor(kTube, 16), fine = tube_linear_factor(kTube, 32);
  std::printf("Lame over finite elements, 16 and 32 around: %.5f %.5f\n", coarse, fine);
  EXPECT_NEAR(coarse, 1.0, 0.03);
  EXPECT_NEAR(fine, 1.0, 0.01);
  EXPECT_LT(std::abs(fine - 1.0), 0.4 * std::abs(coarse - 1.0) + 1e-4);
}

WallLaw law(WallLaw::Kind kind) {
  WallLaw l;
  l.kind = kind;
  l.mu = 50e3;
  l.lambda = 1e3 * l.mu;
  return l;
}

TEST(FullTube, FibresAreThoseOfTheQuadrature) {
  WallLaw l = law(WallLaw::Kind::fibres);
  const double k1 = 40e3, k2 = 3.0, angle = 40.0 * std::numbers::pi / 180.0, c2 = std::pow(std::cos(angle), 2);
  l.k1 = 0.25 * k1, l.k2 = 0.25 * k2, l.beta = angle;
  const auto reduced = [&](double C) {  // 2 k1 E exp(k2 E^2) cos^2 l^2 over r, midpoint rule
    double sum = 0.0;
    const double ri = std::sqrt(kTube.inner * kTube.inner + 2 * C), ro = std::sqrt(kTube.outer * kTube.outer + 2 * C);
    for (int i = 0; i < 400; ++i) {
      const double r = ri + (ro - ri) * (i + 0.5) / 400, l2 = r * r / (r * r - 2 * C), e = 0.5 * c2 * (l2 - 1.0);
      sum += (ro - ri) / 400 * 2 * k1 * e * std::exp(k2 * e * e) * c2 * l2 / r;
    }
    return sum;
  };
  const double most = 0.15 * kTube.outer * kTube.outer;
  const WallTable t = tube_table(kTube, l, 0.0, most, reduced, 24);
  ASSERT_TRUE(std::isfinite(t.linear));
  ASSERT_EQ(t.C.size(), 7u);
  for (std::size_t i = 1; i < t.C.size(); ++i) EXPECT_LT(std::abs(t.beyond[i]), 0.02 * reduced(t.C[i]) + 20.0) << t.C[i];
}

TEST(FullTube, StiffeningIsThatOfTheQuadrature) {
  WallLaw l = law(WallLaw::Kind::yeoh);
  l.c20 = 25e3;
  const auto reduced = [&](double C) {  // 4 c20 (I1 - 3)(l^2 - l^-2) over r, midpoint rule
    double sum = 0.0;
    const double ri = std::sqrt(kTube.inner * kTube.inner + 2 * C), ro = std::sqrt(kTube.outer * kTube.outer + 2 * C);
    for (int i = 0; i < 400; ++i) {
      const double r = ri + (ro - ri) * (i + 0.5) / 400, l2 = r * r / (r * r - 2 * C);
      sum += (ro - ri) / 400 * 4 * l.c20 * (l2 + 1 / l2 - 2) * (l2 - 1 / l2) / r;
    }
    return sum;
  };
  const double most = 0.15 * kTube.outer * kTube.outer;
  const WallTable t = tube_table(kTube, l, 0.0, most, reduced, 24);
  ASSERT_TRUE(std::isfinite(t.linear));
  ASSERT_EQ(t.C.size(), 7u);
  EXPECT_GT(reduced(t.C.back()), 1e3);
  for (std::size_t i = 1; i < t.C.size(); ++i) EXPECT_LT(std::abs(t.beyond[i]), 0.02 * reduced(t.C[i]) + 20.0) << t.C[i];
}

TEST(FullTube, OpeningAngleIsTheSectorsPressure) {
  // without what the reduced model says the table is the whole pressure of the closed sector beyond the ring's; here against its own quadrature
  const double angle = 100.0 * std::numbers::pi / 180.0, k = 1.0 / (1.0 - angle / (2 * std::numbers::pi)), mu = 50e3, a = kTube.inner, b = kTube.outer;
  const auto pressure = [&](double K, double C, double R) {
    double P = 0.0;
    const double ri = std::sqrt(a * a + 2 * C), ro = std::sqrt(b * b + 2 * C);
    for (int i = 0; i < 400; ++i) {
      const double r = ri + (ro - ri) * (i + 0.5) / 400, l = r * K / std::sqrt(R * R + K * (r * r - ri * ri));
      P += (ro - ri) / 400 * mu * (l * l - 1 / (l * l)) / r;
    }
    return P;
  };
  double low = 0.2 * a, high = 6 * a * k;
  for (int i = 0; i < 50; ++i) (pressure(k, 0.0, 0.5 * (low + high)) > 0 ? low : high) = 0.5 * (low + high);
  const WallTable t = tube_table(kTube, law(WallLaw::Kind::neo_hookean), angle, 0.1 * b * b, [](double) { return 0.0; }, 24);
  ASSERT_TRUE(std::isfinite(t.linear));
  const double whole = pressure(1.0, 0.1 * b * b, a);
  for (std::size_t i = 1; i < t.C.size(); ++i) EXPECT_NEAR(t.beyond[i], pressure(k, t.C[i], low) - pressure(1.0, t.C[i], a), 0.01 * whole) << i;
}

}  // namespace
}  // namespace filum::reconcile
