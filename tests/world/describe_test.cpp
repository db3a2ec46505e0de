#include "world/describe.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "world/brain_section.h"

namespace filum {
namespace describe_test {

constexpr double kPi = std::numbers::pi;

/// A wall's layers are made from the lumen outward; told they are from outside, as depths are.
TEST(Describe, LayersCountFromOutside) {
  VesselModel v;
  v.mesh = make_card({});
  v.thickness = 0.2e-3;
  v.layers = {{"intima", 0.02e-3, {}}, {"media", 0.1e-3, {}}, {"adventitia", 0.08e-3, {}}};
  TissueDescription d;
  describe_tissue(v, d);
  ASSERT_EQ(d.layers.size(), 3u);
  const double from[] = {0.0, 0.4, 0.9}, to[] = {0.4, 0.9, 1.0};
  const char* name[] = {"adventitia", "media", "intima"};
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(d.layers[k].name, name[k]);
    EXPECT_NEAR(d.layers[k].from, from[k], 1e-12);
    EXPECT_NEAR(d.layers[k].to, to[k], 1e-12);
  }
  EXPECT_EQ(d.rest, v.mesh.nodes);
  EXPECT_EQ(d.triangles.size(), 2 * v.mesh.faces.size());
  EXPECT_EQ(d.clamp_reach, 0.0) << "no vessel, no clamps";
  EXPECT_EQ(d.second, 0);
}

/// End to side, both rims begin at the heel and run the same way round, so that places on one face those on the other; the axes are those of the two vessels.
TEST(Describe, EdgesOfAnEndToSideJoinRunSideBySide) {
  VesselModel v;
  v.lumen = true;
  v.kind = "vessel";
  v.thickness = 0.1e-3;
  v.clamp.X_WB = {Vec3(1e-3, 2e-3, 3e-3), Quat(Eigen::AngleAxisd(0.6, Vec3(1, 2, -1).normalized()))};
  v.clamp.gap = 0.1e-3;
  SideHold hold;
  hold.lean = 0.25 * kPi;
  v.clamp.side = hold;
  v.shape.around = 16;
  v.shape.along = 4;
  TubeShape vessel = v.shape;
  vessel.along = 14;
  SideOpening opening;
  opening.length = 1.0e-3;
  opening.across = 4;
  opening.along = 6;
  v.mesh = make_end_to_side(vessel, opening, v.shape, v.clamp);
  v.cut_along = v.clamp.X_WB.q * Vec3::UnitZ();
  std::reverse(v.mesh.edge_ring[1].begin(), v.mesh.edge_ring[1].end());  // whichever way round a mesh gives them
  TissueDescription d;
  describe_tissue(v, d);
  ASSERT_GT(d.second, 0);
  EXPECT_EQ(v.mesh.node_part[static_cast<std::size_t>(d.second)], 1);
  EXPECT_EQ(v.mesh.node_part[static_cast<std::size_t>(d.second) - 1], 0);
  const Vec3 up = v.clamp.X_WB.q * Vec3::UnitY();
  std::array<Vec3, 2> quarter;
  for (std::size_t part = 0; part < 2; ++part) {
    const std::vector<Vec3>& rim = d.edges[part].rim;
    ASSERT_EQ(rim.size(), v.mesh.edge_ring[part].size());
    for (const Vec3& p : rim) EXPECT_LE(p.dot(v.cut_along), rim[0].dot(v.cut_along));
    quarter[part] = rim[rim.size() / 4] - v.clamp.X_WB.p;
  }
  const Vec3 across = v.cut_along.cross(up);
  EXPECT_GT(std::abs(quarter[0].dot(across)), 0.1e-3) << "beside the cut's long axis";
  EXPECT_GT(quarter[0].dot(across) * quarter[1].dot(across), 0.0) << "to the same side";
  EXPECT_LT((d.edges[0].axis - v.cut_along).norm(), 1e-12);
  EXPECT_NEAR(d.edges[1].axis.dot(v.cut_along), -std::cos(hold.lean), 1e-12);
  EXPECT_LT((d.axis - v.cut_along).norm(), 1e-12);
  EXPECT_EQ(d.middle, v.clamp.X_WB.p);
}

BrainModel brain() {
  BrainModel m;
  CortexShape shape;
  shape.cells = {8, 6, 3};
  m.cortex = make_cortex(shape, "test");
  BladeShape wide, narrow;
  narrow.name = "narrow";
  narrow.width = narrow.tip_width = 5e-3;
  m.blades = {{wide, narrow}, {wide, narrow}};
  m.blade_names = {"left", "right"};
  m.section_x = 1e-3;
  return m;
}

TEST(Describe, OfTheBrainOnlyItsSurfaceIsTold) {
  BrainModel m = brain();
  m.veins.push_back({m.cortex.surface_nodes[7], Vec3(0.0, 0.0, 0.02), 0.0, 0.0, 0.0});
  BrainDescription d;
  describe_brain(m, d);
  ASSERT_EQ(d.rest.cols(), static_cast<Eigen::Index>(m.cortex.surface_nodes.size()));
  ASSERT_LT(d.rest.cols(), m.cortex.mesh.nodes.cols());
  ASSERT_EQ(d.triangles.size(), m.cortex.surface.size());
  for (std::size_t k = 0; k < d.triangles.size(); ++k)
    for (std::size_t i = 0; i < 3; ++i) ASSERT_EQ(d.rest.col(d.triangles[k][i]), m.cortex.mesh.nodes.col(m.cortex.surface[k][i])) << k;
  ASSERT_EQ(d.veins.size(), 1u);
  EXPECT_EQ(d.veins[0].vertex, 7);
  ASSERT_FALSE(d.section_triangles.empty());
  EXPECT_LT((d.section_rest.row(0).array() - m.section_x).abs().maxCoeff(), 0.11e-3) << "moved aside by a tenth of a millimetre at most";
}

/// Blade i is tool i; then come their second forms; a falx stands behind all of them, across the whole field.
TEST(Describe, BladesComeInTheOrderOfToolsThenForms) {
  BrainModel m = brain();
  BrainDescription d;
  describe_brain(m, d);
  ASSERT_EQ(d.blades.size(), 4u);
  EXPECT_EQ(d.blades[0].name, "left");
  EXPECT_EQ(d.blades[1].name, "right");
  EXPECT_EQ(d.blades[2].name, "narrow");
  EXPECT_EQ(d.blades[3].width, 5e-3);
  m.falx = {4e-3, -10e-3, 5e-3};
  BrainDescription with;
  describe_brain(m, with);
  ASSERT_EQ(with.blades.size(), 5u);
  const BladeDescription& falx = with.blades.back();
  EXPECT_EQ(falx.name, "falx");
  EXPECT_EQ(falx.triangles.size(), 2u);
  const Vec3 low = falx.vertices.rowwise().minCoeff(), high = falx.vertices.rowwise().maxCoeff();
  EXPECT_EQ(low.tail<2>(), Eigen::Vector2d(4e-3, -10e-3));
  EXPECT_EQ(high.tail<2>(), Eigen::Vector2d(4e-3, 5e-3));
  EXPECT_NEAR(falx.vertices.row(2).mean(), -2.5e-3, 1e-15) << "two corners below, two above";
  EXPECT_EQ(high.x() - low.x(), 2.0 * m.cortex.mesh.nodes.row(0).cwiseAbs().maxCoeff());
}

TEST(Describe, NeedleIsDrawnByItsOwnMeasures) {
  NeedleShape shape;
  shape.name = "mine";
  shape.circle = 0.5;
  NeedleDescription d;
  describe_needle(shape, d);
  EXPECT_TRUE(d.present);
  EXPECT_EQ(d.name, "mine");
  EXPECT_NEAR(d.angle, kPi, 1e-12);
  EXPECT_EQ(d.bend_radius, shape.bend_radius);
  EXPECT_EQ(d.wire_radius, shape.wire_radius);
  EXPECT_EQ(d.taper, shape.taper);
}

}  // namespace describe_test
}  // namespace filum
