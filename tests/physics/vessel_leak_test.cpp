#include "physics/vessel_leak.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "physics/vessel_clamp.h"

using namespace filum;

namespace vessel_leak_test {

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

/// Two bevelled stumps, the second the first turned half round about the cut's shorter axis and moved off along the cut's normal: loops that lie off the
/// vessel's axis, everywhere the same gap apart, leak as an orifice of that area, and each sector its equal share of the loop's length.
TEST(VesselLeak, LoopsOffTheAxisLeakAsAnOrificeOfTheirArea) {
  TubeShape shape;
  shape.around = 48;
  shape.bevel = 0.25 * kPi;
  const double gap = 0.5e-3;
  const VesselMesh stump = make_tube(shape);
  const Vec3 normal = Vec3(-1, 0, 1).normalized(), at(0, 0, shape.length);
  VesselMesh mesh;
  append(mesh, stump, {});
  const Quat half(Eigen::AngleAxisd(kPi, Vec3::UnitY()));
  append(mesh, stump, {at + gap * normal - half * at, half});
  const BloodOptions blood;
  const JoinLeak leak = find_leak(mesh, mesh.nodes, 0, 1, 8, blood);
  double around = 0.0, longest = 0.0;
  const auto& ring = mesh.edge_ring[0];
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const double side = (mesh.nodes.col(ring[(k + 1) % ring.size()]) - mesh.nodes.col(ring[k])).norm();
    around += side;
    longest = std::max(longest, side);
  }
  const double a = 0.35e-3 * std::sqrt(2.0), b = 0.35e-3, h = (a - b) * (a - b) / ((a + b) * (a + b));
  EXPECT_NEAR(around, kPi * (a + b) * (1.0 + 3.0 * h / (10.0 + std::sqrt(4.0 - 3.0 * h))), 3e-3 * around) << "Ramanujan's ellipse";
  EXPECT_NEAR(leak.area, around * gap, 1e-6 * leak.area);
  EXPECT_NEAR(leak.flow, leak.area * slit_speed(gap, shape.thickness, blood), 0.01 * leak.flow) << "as deep as 1.4 walls along the slanting cut";
  double sum = 0.0;
  for (const LeakSector& s : leak.sectors) {
    EXPECT_NEAR(s.gap, gap, 1e-9);
    EXPECT_NEAR(s.length, around / 8.0, longest);
    sum += s.flow;
  }
  EXPECT_NEAR(sum, leak.flow, 1e-9 * leak.flow);
}

TEST(VesselLeak, PassageLeadsThroughTheOpening) {
  TubeShape vessel, stump;
  vessel.around = 20;
  vessel.along = 24;
  vessel.edge_grading = 1.0;
  DoubleClamp clamp;
  clamp.side = SideHold{0.25 * kPi, 2.2e-3, 0.45e-3};
  const VesselMesh mesh = make_end_to_side(vessel, {}, stump, clamp);
  const Passage way = passage_of(mesh);
  EXPECT_EQ(way.second, 13u) << "as far as the opening's middle";
  EXPECT_EQ(way.rings.size(), 13u + 16u);
  const auto rings = lumen_rings(way, mesh.nodes);
  const double round = 24.0 * 0.5 * 0.35e-3 * 0.35e-3 * std::sin(2.0 * kPi / 24.0);
  for (std::size_t k = way.second; k < rings.size(); ++k) EXPECT_NEAR(rings[k].area / round, 1.0, 1e-6) << "bevelled rings count as they stand across";
  EXPECT_NEAR(rings[0].area / round, std::sin(2.0 * kPi / 20.0) * 20.0 / (24.0 * std::sin(2.0 * kPi / 24.0)), 1e-3);
  EXPECT_GT(rings[12].area / rings[0].area, 0.82) << "a chord closes the ring at the opening";
  EXPECT_LT(rings[12].area / rings[0].area, 0.95);
}

TEST(VesselLeak, LumenNarrowing) {
  TubeShape shape;
  shape.around = 96;
  const VesselMesh mesh = make_tube(shape);
  const double area = kPi * 0.35e-3 * 0.35e-3;
  const auto rings = lumen_rings(mesh, mesh.nodes, 0);
  ASSERT_EQ(rings.size(), 16u);
  for (const LumenRing& r : rings) EXPECT_NEAR(r.area / area, 1.0, 1e-3);
  EXPECT_NEAR(narrowing_of(rings, area), 0.0, 2e-3);
  Points x = mesh.nodes;
  for (int i = 0; i < x.cols(); ++i)
    if (mesh.slab[static_cast<std::size_t>(i)] == 9) x.col(i).head<2>() *= 0.5;
  EXPECT_NEAR(narrowing_of(lumen_rings(mesh, x, 0), area), 0.75, 2e-3);
  x = mesh.nodes;
  x.row(1) *= 1e-3;  // collapsed flat
  EXPECT_GT(narrowing_of(lumen_rings(mesh, x, 0), area), 0.99);
}

}  // namespace vessel_leak_test
