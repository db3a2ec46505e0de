#include "physics/vessel_leak.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "physics/vessel_clamp.h"

using namespace filum;

namespace {

constexpr double kPi = std::numbers::pi;

TEST(VesselLeak, WideGapsObeyTheOrificeLaw) {
  const BloodOptions blood;
  const double v = slit_speed(1e-3, 1e-4, blood);
  EXPECT_NEAR(v, 0.6 * std::sqrt(2.0 * 13332.0 / 1055.0), 1e-3 * v);
  EXPECT_NEAR(v * 1e-8 * 6e7, 1.8, 0.05);  // 0.01 mm2: about 1.8 mL/min
}

TEST(VesselLeak, NarrowGapsObeyPoiseuille) {
  const BloodOptions blood;
  const double g = 4e-6, d = 1e-4;
  EXPECT_NEAR(slit_speed(g, d, blood), g * g * blood.pressure / (12.0 * blood.viscosity * d), 2e-2 * slit_speed(g, d, blood));
  EXPECT_EQ(slit_speed(2e-6, d, blood), 0.0);
}

TEST(VesselLeak, GapsOfTwoStumps) {
  TubeShape shape;
  DoubleClamp clamp;
  clamp.gap = 50e-6;
  const VesselMesh mesh = make_stumps(shape, clamp);
  const BloodOptions blood;
  const JoinLeak leak = find_leak(mesh, mesh.nodes, 0, 1, 8, blood);
  ASSERT_EQ(leak.sectors.size(), 8u);
  const double around = 24.0 * 2.0 * 0.35e-3 * std::sin(kPi / 24.0);
  EXPECT_NEAR(leak.area, around * 50e-6, 1e-3 * leak.area);
  EXPECT_NEAR(leak.flow, leak.area * slit_speed(50e-6, 1e-4, blood), 1e-3 * leak.flow);
  for (const LeakSector& s : leak.sectors) {
    EXPECT_NEAR(s.gap, 50e-6, 1e-9);
    EXPECT_NEAR(s.flow, leak.flow / 8.0, 1e-3 * leak.flow);
    EXPECT_NEAR(s.place.z(), 0.0, 1e-9);
  }
}

TEST(VesselLeak, OnlyTheOpenSectorLeaks) {
  DoubleClamp clamp;
  clamp.gap = 0.0;
  const VesselMesh mesh = make_stumps({}, clamp);
  Points x = mesh.nodes;
  const int middle = mesh.edge_ring[0][4];  // between sectors 1 and 2 of 8, three nodes each: pulled back with its outer end
  x(2, middle) -= 40e-6;
  x(2, middle + 1) -= 40e-6;
  const JoinLeak leak = find_leak(mesh, x, 0, 1, 8, {});
  EXPECT_GT(leak.sectors[1].flow, 0.0);
  EXPECT_NEAR(leak.sectors[1].flow, leak.flow, 1e-12 * leak.flow);
  EXPECT_EQ(leak.sectors[5].flow, 0.0);
  // pulled back by 40 um at one node, to nothing at its neighbours: a triangle
  const double side = 2.0 * 0.35e-3 * std::sin(kPi / 24.0);
  EXPECT_NEAR(leak.area, 40e-6 * side, 0.1 * leak.area);
}

TEST(VesselLeak, LumenNarrowingAndPoiseuilleFlow) {
  TubeShape shape;
  shape.around = 96;
  const VesselMesh mesh = make_tube(shape);
  const double area = kPi * 0.35e-3 * 0.35e-3;
  const auto rings = lumen_rings(mesh, mesh.nodes, 0);
  ASSERT_EQ(rings.size(), 16u);
  for (const LumenRing& r : rings) EXPECT_NEAR(r.area / area, 1.0, 1e-3);
  const BloodOptions blood;
  const Patency open = assess_lumen(rings, area, blood);
  EXPECT_NEAR(open.resistance, 8.0 * blood.viscosity * 3e-3 / (kPi * std::pow(0.35e-3, 4)), 3e-3 * open.resistance);
  EXPECT_NEAR(open.flow, blood.pressure / open.resistance, 1e-12);
  EXPECT_TRUE(open.patent);
  EXPECT_NEAR(open.narrowing, 0.0, 2e-3);
  Points x = mesh.nodes;
  for (int i = 0; i < x.cols(); ++i)
    if (mesh.slab[static_cast<std::size_t>(i)] == 9) x.col(i).head<2>() *= 0.5;
  const Patency tight = assess_lumen(lumen_rings(mesh, x, 0), area, blood);
  EXPECT_NEAR(tight.narrowing, 0.75, 2e-3);
  EXPECT_FALSE(tight.patent);
  EXPECT_LT(tight.flow, open.flow);
  x = mesh.nodes;
  x.row(1) *= 1e-3;  // collapsed flat
  EXPECT_GT(assess_lumen(lumen_rings(mesh, x, 0), area, blood).narrowing, 0.99);
}

}  // namespace
