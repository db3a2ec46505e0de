// An inflated slice against Lame's thick tube. More tubes, with orders of convergence: `filum validate vessel-*`.

#include "physics/tube_slice.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace filum;

namespace {

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

}  // namespace
