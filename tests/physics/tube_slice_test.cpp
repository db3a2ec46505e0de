// An inflated slice against Lame's thick tube. More tubes, with orders of convergence: `filum validate vessel-*`.

#include "physics/tube_slice.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace filum;

namespace tube_slice_test {

TEST(TubeSlice, SmallPressureWidensItAsLameSays) {
  const double a = 0.5e-3, b = 0.75e-3, E = 500e3, nu = 0.3, P = 10.0;
  TubeSlice s;
  s.shape.inner_radius = a;
  s.shape.thickness = b - a;
  s.shape.length = 0.1e-3;
  s.layers = {{"wall", b - a, WallLaw::hooke(E, nu)}};
  s.around = 32, s.through = 8;
  const SliceState at = inflate(s, {P}).front();
  ASSERT_TRUE(at.converged);
  // plane strain: u(r) = (1 + nu) P a^2 / (E (b^2 - a^2)) ((1 - 2 nu) r + b^2/r)
  const auto u = [&](double r) { return (1 + nu) * P * a * a / (E * (b * b - a * a)) * ((1 - 2 * nu) * r + b * b / r); };
  EXPECT_NEAR((at.inner - a) / u(a), 1.0, 0.01);
  EXPECT_NEAR((at.outer - b) / u(b), 1.0, 0.01);
}

/// Hooke, incompressible, small strain: at motion C the strain around is C/R^2, an element's energy 2 mu (C/R^2)^2, and P = int s(R) 4 mu C/R^3 dR.
TEST(TubeSlice, EveryElementSoftensByItsOwnPast) {
  const double a = 0.5e-3, b = 0.8e-3, mu = 1e5, top = 1e-4 * a * b, most = 2.0 * mu * 1e-8;
  TubeSlice s;
  s.shape.inner_radius = a;
  s.shape.thickness = b - a;
  s.shape.length = 0.1e-3;
  s.layers = {{"wall", b - a, WallLaw::hooke(2.0 * mu * 1.4999, 0.4999)}};
  s.around = 32, s.through = 8;
  for (const auto shape : {WallSoftening::Shape::exponential, WallSoftening::Shape::error_function, WallSoftening::Shape::fraction}) {
    const WallSoftening soft{shape, 0.4, 0.3 * most};
    const std::vector<double> way = {0.6, 1.0, 0.7, 0.3, 0.8, 1.0, 1.2};
    std::vector<double> radii;
    for (const double share : way) radii.push_back(a + share * top / a);
    const auto P = borne(s, soft, radii);
    double past = 0.0, worst = 0.0;
    for (std::size_t k = 0; k < way.size(); ++k) {
      past = std::max(past, way[k]);
      double exact = 0.0, firm = 0.0;
      constexpr int kPoints = 2000;
      for (int i = 0; i < kPoints; ++i) {
        const double R = a + (b - a) * (i + 0.5) / kPoints, C = way[k] * top, W = 2.0 * mu * std::pow(C / (R * R), 2), dP = 4.0 * mu * C / (R * R * R) * (b - a) / kPoints;
        firm += dP;
        exact += dP * soft.left(W, W * std::pow(past / way[k], 2));
      }
      worst = std::max(worst, std::abs(P[k] / exact - 1.0));
      if (way[k] == past) {
        EXPECT_NEAR(exact / firm, 1.0, 1e-12);  // new ground
      } else {
        EXPECT_LT(exact, 0.95 * firm);
      }
    }
    std::printf("softening: pressures off the quadrature by %.4f\n", worst);
    EXPECT_LT(worst, 0.01);
  }
}

}  // namespace tube_slice_test
