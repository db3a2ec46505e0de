#include "physics/wall_meeting.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numbers>

#include "physics/vessel_clamp.h"
#include "physics/vessel_leak.h"
#include "physics/vessel_wall.h"

using namespace filum;

namespace wall_meeting_test {

std::vector<WallLayer> soft_wall() {
  WallLaw law;
  law.kind = WallLaw::Kind::neo_hookean;
  law.mu = 40e3;
  law.lambda = 2e6;
  return {{"wall", 1e-4, law}};
}

TubeShape stump_shape() {
  TubeShape s;
  s.around = 16;
  s.along = 8;
  s.length = 1.2e-3;
  return s;
}

/// Two stumps whose cut edges are `gap` apart.
VesselMesh stumps(double gap) {
  DoubleClamp c;
  c.gap = gap;
  return make_stumps(stump_shape(), c);
}

/// The clamp goes a step on its way to a gap.
void slide(VesselWall& wall, const DoubleClamp& first, DoubleClamp& now, double gap, double length) {
  now = approach(now, gap, 0.0, 2e-3, 0.5e-3, 1.0);
  const auto motion = clamp_motion(first, now, length);
  for (int part = 0; part < 2; ++part) wall.place_clamp(part, motion[static_cast<std::size_t>(part)]);
}

TEST(WallMeeting, FindsTheOppositeEdgeWithinReachOnly) {
  const VesselMesh near = stumps(20e-6), far = stumps(80e-6);
  WallMeetings m(near, 50e-6, 30.0);
  m.find(near, SurfaceTree(face_triangles(near), near.nodes), near.nodes);
  EXPECT_EQ(m.size(), 2 * 2 * 16) << "the nodes of both edges";
  for (int k = 0; k < m.size(); ++k) {
    EXPECT_NEAR(m.overlap(k, near.nodes), -20e-6, 1e-12);
    EXPECT_NEAR(std::abs(m[k].normal.z()), 1.0, 1e-12);
  }
  m.find(far, SurfaceTree(face_triangles(far), far.nodes), far.nodes);
  EXPECT_EQ(m.size(), 0);
}

/// Forces are minus the gradient of the energy, and balance.
TEST(WallMeeting, ForceIsTheGradientAndActsOnBothSides) {
  const VesselMesh mesh = stumps(-8e-6);
  WallMeetings m(mesh, 50e-6, 30.0);
  m.find(mesh, SurfaceTree(face_triangles(mesh), mesh.nodes), mesh.nodes);
  ASSERT_GT(m.size(), 0);
  Points f = Points::Zero(3, mesh.n_nodes()), scratch = f;
  EXPECT_NEAR(m.add_forces(mesh.nodes, f), m.size() * 0.5 * 30.0 * 8e-6 * 8e-6, 1e-15);
  EXPECT_LT(f.rowwise().sum().norm(), 1e-15);
  Points slid = mesh.nodes;  // one edge sticks, rubbed by less than friction gives before it slips; a node of it slips
  for (int i = 0; i < slid.cols(); ++i)
    if (mesh.node_part[static_cast<std::size_t>(i)] == 0) slid.col(i) += Vec3(1e-6, 0.5e-6, 0.0);
  slid.col(m[0].node) += Vec3(9e-6, -4e-6, 0.0);
  f.setZero();
  m.add_forces(slid, f);
  EXPECT_LT(f.rowwise().sum().norm(), 1e-15);
  EXPECT_GT(f.topRows(2).norm(), 1e-5) << "friction, across the normals";
  for (const int i : {m[0].node, m[0].face[0], m[5].face[2]})
    for (int c = 0; c < 3; ++c) {
      const double h = 1e-9;
      Points x = slid;
      x(c, i) += h;
      const double up = m.add_forces(x, scratch);
      x(c, i) -= 2.0 * h;
      EXPECT_NEAR(-(up - m.add_forces(x, scratch)) / (2.0 * h), f(c, i), 1e-9);
    }
}

/// The clamp slid until the stumps would overlap by 40 micrometres: edges press on each other and stay outside one another. The same
/// without contact: they pass.
TEST(WallMeeting, EdgesPressedTogetherStayApart) {
  for (const bool met : {true, false}) {
    DoubleClamp first, now;
    first.gap = now.gap = 60e-6;
    const TubeShape shape = stump_shape();
    WallOptions options;
    options.max_iterations = 40;
    VesselWall wall(make_stumps(shape, first), soft_wall(), options);
    WallState state = wall.first_state();
    for (int k = 0; k < 200; ++k) {
      slide(wall, first, now, -40e-6, shape.length);
      wall.refit(state);
      if (met) wall.meet(state);
      ASSERT_TRUE(wall.step(state).sound) << k;
    }
    double past = -1.0;  // by which the first edge reaches beyond the second, at the same angle
    const auto &a = wall.mesh().edge_ring[0], &b = wall.mesh().edge_ring[1];
    for (const int i : a)
      for (const int j : b)
        if ((state.x.col(i) - state.x.col(j)).head<2>().norm() < 60e-6) past = std::max(past, state.x(2, i) - state.x(2, j));
    if (met)
      EXPECT_LT(past, 15e-6);
    else
      EXPECT_GT(past, 30e-6);
  }
}

/// Edges drawn over each other by a stitch at the top, and held: they come to rest. Without friction they shook for ever (11 um a step; the edges of a sewn artery 60 um):
/// each step led nodes of either edge past the faces that they had been paired with, and the next one back.
TEST(WallMeeting, EdgesDrawnOverEachOtherComeToRest) {
  DoubleClamp first, now;
  first.gap = now.gap = 0.6e-3;
  TubeShape shape;
  shape.inner_radius = 0.3e-3;
  shape.thickness = 0.14e-3;
  shape.around = 24;
  shape.along = 10;
  shape.length = 2e-3;
  WallLaw law;
  law.kind = WallLaw::Kind::neo_hookean;
  law.mu = 40e3;
  law.lambda = 3e6;
  VesselWall wall(make_stumps(shape, first), {{"wall", shape.thickness, law}}, WallOptions{});
  WallState state = wall.first_state();
  std::array<WallPoint, 2> held;
  std::array<Vec3, 2> from;
  for (const std::size_t side : {0, 1}) {
    const Vec3 beside(0.0, 0.44e-3, (side == 0 ? -1.0 : 1.0) * 0.6e-3);
    held[side] = wall.nearest(state, beside, 0.3e-3).point;
    from[side] = wall.position(state, held[side]);
  }
  double last = 0.0;  // [m], moved in a step at most, on average over the last half second
  for (int k = 0; k < 2000; ++k) {
    slide(wall, first, now, 0.2e-3, shape.length);
    wall.clear_loads();
    for (const std::size_t side : {0, 1}) {
      const double share = std::min(1.0, k / 1000.0);
      Vec3 to = from[side];
      to.z() = (side == 0 ? -1.0 : 1.0) * 0.15e-3;
      to.y() -= side == 0 ? 0.06e-3 : 0.1e-3;
      const Vec3 away = (1.0 - share) * from[side] + share * to - wall.position(state, held[side]);
      wall.add_load(state, held[side], 30.0 * away, Mat3(30.0 * Mat3::Identity()));
    }
    wall.refit(state);
    wall.meet(state);
    const Points before = state.x;
    ASSERT_TRUE(wall.step(state).sound) << k;
    if (k >= 1750) last += (state.x - before).colwise().norm().maxCoeff() / 250.0;
  }
  EXPECT_LT(last, 3e-6);
}

/// A vein's wall, sucked empty and filled again: it lies flat with its walls on each other and opens to what it was. The same without contact: they pass.
TEST(WallMeeting, AnEmptyVeinLiesFlatAndFillsAgain) {
  TubeShape shape;
  shape.inner_radius = 0.36e-3;
  shape.thickness = 33e-6;
  shape.around = 24;
  shape.along = 8;
  shape.length = 2.4e-3;
  WallLaw law;
  law.kind = WallLaw::Kind::neo_hookean;
  law.mu = 8e3;
  law.lambda = 1e6;
  WallOptions options;
  options.tolerance = 5e-6;
  options.memory = 40;
  for (const bool met : {true, false}) {
    VesselWall wall(make_tube(shape), {{"wall", 33e-6, law}}, options);
    WallState state = wall.first_state();
    for (int i = 0; i < state.x.cols(); ++i) state.x(0, i) *= wall.mesh().slab[static_cast<std::size_t>(i)] == 0 ? 1.0 : 1.01;  // no tube is quite round
    const auto area = [&] { return lumen_rings(wall.mesh(), state.x, 0).back().area; };
    const double first = area();
    const auto go = [&](double from, double to, int steps) {
      for (int k = 1; k <= steps; ++k) {
        wall.set_pressure(0, from + (to - from) * std::min(1.0, 2.0 * k / steps));
        wall.refit(state);
        if (met) wall.meet(state);
        ASSERT_TRUE(wall.step(state).sound) << k;
        ASSERT_TRUE(state.x.allFinite() && state.x.cwiseAbs().maxCoeff() < 3e-3) << k;
      }
    };
    go(0.0, -120.0, 160);
    const double flat = area();
    WallMeetings across(wall.mesh(), 16e-6, 1.0);
    across.find(wall.mesh(), SurfaceTree(face_triangles(wall.mesh()), state.x), state.x);
    double deepest = -1.0;
    for (int k = 0; k < across.size(); ++k) deepest = std::max(deepest, across.overlap(k, state.x));
    EXPECT_GE(across.size(), 12) << "pairs across, or there is nothing to look at";
    if (met) {
      EXPECT_LT(flat, 0.35 * first);
      EXPECT_GT(deepest, 0.0) << "its walls touch";
      EXPECT_LT(deepest, 5e-6);
      go(-120.0, 400.0, 120);  // a long neo-Hookean tube blows up like a balloon above mu t / r = 730 Pa; below, 1 - lambda^-4 = p r / (mu t)
      EXPECT_GT(area(), first);
      EXPECT_LT(area(), 2.0 * first);
    } else {
      EXPECT_GT(deepest, 30e-6) << "a wall's thickness";
    }
  }
}

}  // namespace wall_meeting_test
