#include "physics/vessel_flow.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "physics/vessel_clamp.h"

using namespace filum;

namespace vessel_flow_test {

constexpr double kPi = std::numbers::pi, kRadius = 0.35e-3;
constexpr int kAround = 48;

VesselMesh stumps() {
  TubeShape shape;
  shape.around = kAround;
  shape.along = 30;
  DoubleClamp clamp;
  clamp.gap = 0.0;
  return make_stumps(shape, clamp);
}

double polygon_area() { return 0.5 * kAround * kRadius * kRadius * std::sin(2.0 * kPi / kAround); }

TEST(VesselFlow, AreaVolumeAndResistanceOfATube) {
  const VesselMesh mesh = stumps();
  LumenLine line(mesh);
  const BloodOptions blood;
  line.measure(mesh.nodes, blood.viscosity);
  const double area = polygon_area();
  EXPECT_NEAR(line.length(), 6e-3, 1e-9);
  EXPECT_NEAR(line.join(), 3e-3, 1e-9);
  EXPECT_NEAR(line.least_area(), area, 1e-6 * area);
  EXPECT_NEAR(line.volume(1.05e-3, 4.3e-3), area * 3.25e-3, 1e-6 * area * 3.25e-3);
  EXPECT_NEAR(line.resistance(1.05e-3, 4.3e-3), 8.0 * kPi * blood.viscosity * 3.25e-3 / (area * area), 1e-6 * line.resistance(1.05e-3, 4.3e-3));
  EXPECT_EQ(line.volume(4e-3, 3e-3), 0.0);
}

TEST(VesselFlow, BalanceWithoutALeakIsTwoResistancesInARow) {
  const Balance b = balance_blood(13332.0, 2e10, {}, 6e10, 3333.0, {});
  EXPECT_NEAR(b.from, (13332.0 - 3333.0) / 8e10, 1e-6 * b.from);
  EXPECT_NEAR(b.on, b.from, 1e-6 * b.from);
  EXPECT_NEAR(b.pressure, 13332.0 - 2e10 * b.from, 0.1);
}

std::vector<EdgeGap> slits(double gap) {
  std::vector<EdgeGap> gaps(8);
  for (EdgeGap& g : gaps) g = {gap, 0.1e-3, 2.2e-3 / 8.0, Vec3::Zero()};
  return gaps;
}

struct Measured {
  VesselMesh mesh = stumps();
  LumenLine line{mesh};
  BloodOptions blood;
  Circulation c;
  Measured() { line.measure(mesh.nodes, blood.viscosity); }
};

/// Half of the lumen before the cut, half behind it, all in a row with the circulation.
TEST(VesselFlow, ATightOpenJoinLetsThroughWhatTheCirculationTakes) {
  const Measured tube;
  const auto& [mesh, line, blood, c] = tube;
  const double lumen = 8.0 * kPi * blood.viscosity * 6e-3 / (polygon_area() * polygon_area());
  const Balance b = balance_join(line, {}, c, blood);
  EXPECT_NEAR(b.on, (c.pressure - c.back) / (c.upstream() + c.downstream() + lumen), 1e-4 * b.on);
  EXPECT_LT(b.on, c.through) << "5 ml/min, not the 400 that 100 mmHg drive through 6 mm of tube";
  EXPECT_GT(b.on, 0.95 * c.through);
  EXPECT_TRUE(is_patent(0.0, b.on, c));
  EXPECT_FALSE(is_patent(0.5, b.on, c));
}

/// Viscous slits let out in proportion to the pressure, Q = G p with G = s g^3 / (12 mu d): three resistances that meet in the join.
TEST(VesselFlow, WhatLeaksDoesNotGoOnAndAJoinThatGapesIsNotPatent) {
  const Measured tube;
  const auto& [mesh, line, blood, c] = tube;
  const double half = 4.0 * kPi * blood.viscosity * 6e-3 / (polygon_area() * polygon_area()), up = c.upstream() + half, down = c.downstream() + half;
  const double g = 4e-6, leaks = 2.2e-3 * g * g * g / (12.0 * blood.viscosity * 0.1e-3);
  const double p = (c.pressure / up + c.back / down) / (1.0 / up + 1.0 / down + leaks);
  const Balance b = balance_join(line, slits(g), c, blood);
  EXPECT_NEAR(b.on, (p - c.back) / down, 2e-3 * b.on) << "the orifice's share of the slit's law is 1 %";
  EXPECT_TRUE(is_patent(0.0, b.on, c));
  const Balance open = balance_join(line, slits(0.3e-3), c, blood);
  EXPECT_LT(open.on, 0.0) << "collaterals bleed out of the cut";
  EXPECT_NEAR(open.on, (open.pressure - c.back) / down, 1e-6 * c.through);
  EXPECT_FALSE(is_patent(0.0, open.on, c));
}

/// A millimetre at a twentieth of its area has twice the circulation's resistance.
TEST(VesselFlow, ALumenAllButClosedTakesTheFlow) {
  const VesselMesh mesh = stumps();
  LumenLine line(mesh);
  const BloodOptions blood;
  const Circulation c;
  Points x = mesh.nodes;
  for (int i = 0; i < x.cols(); ++i)
    if (std::abs(x(2, i)) < 0.55e-3) x.col(i).head<2>() *= std::sqrt(0.05);
  line.measure(x, blood.viscosity);
  const Balance b = balance_join(line, {}, c, blood);
  EXPECT_NEAR(b.on, (c.pressure - c.back) / (c.upstream() + c.downstream() + line.resistance(0.0, line.length())), 1e-4 * b.on);
  EXPECT_LT(b.on, 0.5 * c.through);
  EXPECT_FALSE(is_patent(0.0, b.on, c));
}

/// One wide gap: Q = C S sqrt(2 p / rho) = (P - p)/R, a quadratic in sqrt(p).
TEST(VesselFlow, BalanceWithAnOrificeSolvesItsQuadratic) {
  const double R = 2e10, P = 13332.0, ring = 1e-3, gap = 0.2e-3;
  std::vector<EdgeGap> gaps(8);
  for (EdgeGap& g : gaps) g = {gap, 1e-9, ring / 8.0, Vec3::Zero()};  // no depth: no friction in the gap
  const BloodOptions blood;
  const double k = R * blood.discharge * gap * ring * std::sqrt(2.0 / blood.density), root = 0.5 * (-k + std::sqrt(k * k + 4.0 * P));
  const Balance b = balance_blood(P, R, gaps, 0.0, 0.0, blood);
  EXPECT_NEAR(b.pressure, root * root, 1e-3 * P);
  EXPECT_NEAR(b.leak, b.from, 1e-3 * b.from);
  EXPECT_EQ(b.on, 0.0);
}

TEST(VesselFlow, AClampThatIsOnIsNoWay) {
  const Balance shut = balance_blood(13332.0, 0.0, {}, 6e10, 3333.0, {});
  EXPECT_NEAR(shut.pressure, 3333.0, 0.1) << "collaterals fill a vessel whose artery is clamped";
  EXPECT_NEAR(shut.on, 0.0, 1e-12);
  EXPECT_EQ(shut.from, 0.0);
}

/// Seconds until a stretch of the second stump is full again, stripped from `from` by `length` [m]; negative if it stays empty.
double refill(const LumenLine& line, double from, double length, const Circulation& c, MilkingNews& news) {
  Milking m;
  const double dt = 1e-5;
  std::array<double, 2> closed = {from, from};
  for (int k = 0; k <= 100; ++k) {
    closed[1] = from + 0.01 * k * length;
    EXPECT_EQ(milk(m, line, closed, true, c, {}, {}, dt), MilkingNews::none);
  }
  closed[0] = -1.0;
  EXPECT_EQ(milk(m, line, closed, true, c, {}, {}, dt), MilkingNews::let_go);
  news = MilkingNews::none;
  while (m.stage == Milking::filling) news = milk(m, line, closed, true, c, {}, {}, dt);
  return news == MilkingNews::refilled ? m.time : -1.0;
}

/// dV/dt = (P - p)/(R_0 + r x), V = A x:  t = A/(P - p) (R_0 L + r L^2/2), with R_0 of all before the stretch.
TEST(VesselFlow, RefillTakesVolumeOverFlow) {
  const VesselMesh mesh = stumps();
  LumenLine line(mesh);
  const BloodOptions blood;
  line.measure(mesh.nodes, blood.viscosity);
  Circulation c;
  c.cut_flow = 2.0 / 60e6;
  const double area = polygon_area(), r = 8.0 * kPi * blood.viscosity / (area * area), from = 3.5e-3, length = 2e-3;
  const double expected = area / (c.pressure - c.opening) * ((c.upstream() + r * from) * length + 0.5 * r * length * length);
  MilkingNews news;
  EXPECT_NEAR(refill(line, from, length, c, news), expected, 2e-3 * expected);
  EXPECT_EQ(news, MilkingNews::refilled);
}

TEST(VesselFlow, BehindAShutLumenItStaysEmptyButANarrowOneRefills) {
  const VesselMesh mesh = stumps();
  const auto rings = inner_rings(mesh, 0);
  Points x = mesh.nodes;
  LumenLine line(mesh);
  MilkingNews news;
  for (const int i : rings[20]) x.col(i).head<2>() *= 0.1;  // one place, by nine tenths of the width
  line.measure(x, 3.5e-3);
  EXPECT_GT(refill(line, 3.5e-3, 2e-3, {}, news), 0.0) << "why the test misses stitches that catch both walls";
  for (const std::size_t k : {std::size_t{20}, std::size_t{21}})
    for (const int i : rings[k]) x.col(i).head<2>() *= 1e-4;
  line.measure(x, 3.5e-3);
  EXPECT_LT(line.least_area(), 1e-5 * polygon_area());
  EXPECT_LT(refill(line, 3.5e-3, 2e-3, {}, news), 0.0);
  EXPECT_EQ(news, MilkingNews::stayed_empty);
}

TEST(VesselFlow, TheFurtherForcepsMustHoldUntilItIsFull) {
  const VesselMesh mesh = stumps();
  LumenLine line(mesh);
  line.measure(mesh.nodes, 3.5e-3);
  Milking m;
  std::array<double, 3> closed = {3.5e-3, 3.6e-3, -1.0};
  EXPECT_EQ(milk(m, line, closed, false, {}, {}, {}, 2e-3), MilkingNews::none);
  EXPECT_EQ(m.stage, Milking::idle) << "clamps on: nothing to be milked";
  milk(m, line, closed, true, {}, {}, {}, 2e-3);
  closed[1] = 5e-3;
  milk(m, line, closed, true, {}, {}, {}, 2e-3);
  EXPECT_NEAR(m.to - m.from, 1.4e-3, 1e-12);
  closed[1] = -1.0;
  EXPECT_EQ(milk(m, line, closed, true, {}, {}, {}, 2e-3), MilkingNews::spoiled);
  EXPECT_EQ(m.stage, Milking::idle);
}

}  // namespace vessel_flow_test
