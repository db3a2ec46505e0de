#include <gtest/gtest.h>

#include <cmath>

#include "physics/vessel_wall.h"

using namespace filum;

namespace vessel_wall_surface_test {

VesselWall plain() {
  TubeShape s;
  WallLaw law = WallLaw::hooke(300e3, 0.45);
  return VesselWall(make_tube(s), {{"intima", 1e-5, law}, {"media", 5e-5, law}, {"adventitia", 4e-5, law}}, {});
}

TEST(VesselWallSurface, ASegmentMeetsOuterThenInnerSurface) {
  VesselWall wall = plain();
  const WallState s = wall.first_state();
  wall.refit(s);
  const Vec3 a(1e-3, 1e-6, 1.51e-3), b(-1e-3, 1e-6, 1.51e-3);
  const WallCrossing in = wall.crossing(s, a, b);
  ASSERT_TRUE(in.found);
  EXPECT_EQ(in.surface, WallSurface::outer);
  EXPECT_EQ(in.layer, 2);
  EXPECT_GT(in.normal.x(), 0.9);
  EXPECT_NEAR((a + in.fraction * (b - a) - wall.position(s, in.point)).norm(), 0.0, 2e-7);
  EXPECT_NEAR(wall.depth_at(in.point), 0.0, 1e-9);
  const WallCrossing through = wall.crossing(s, a, b, in.fraction + 1e-9);
  ASSERT_TRUE(through.found);
  EXPECT_EQ(through.surface, WallSurface::inner);
  EXPECT_EQ(through.layer, 0);
  EXPECT_LT(through.normal.x(), -0.9);
  EXPECT_NEAR((through.fraction - in.fraction) * 2e-3, 1e-4, 2e-6);
  const WallCrossing far_side = wall.crossing(s, a, b, through.fraction + 1e-9);
  EXPECT_EQ(far_side.surface, WallSurface::inner);
  EXPECT_LT(wall.position(s, far_side.point).x(), 0.0);
  EXPECT_FALSE(wall.crossing(s, a, Vec3(0.5e-3, 0, 1.5e-3)).found);
}

TEST(VesselWallSurface, TheCutEdgeIsItsOwn) {
  VesselWall wall = plain();
  const WallState s = wall.first_state();
  wall.refit(s);
  const WallCrossing c = wall.crossing(s, Vec3(0.4e-3, 0, 4e-3), Vec3(0.4e-3, 0, 2.9e-3));
  ASSERT_TRUE(c.found);
  EXPECT_EQ(c.surface, WallSurface::edge);
  EXPECT_NEAR(c.normal.z(), 1.0, 1e-9);
}

/// What crosses the surface, what is nearest to it and where a place on it lies agree on twisted sides too, which the element's own interpolation does not meet.
TEST(VesselWallSurface, PlacesLieWhereTheyAreFoundOnTwistedSides) {
  VesselWall wall = plain();
  WallState s = wall.first_state();
  for (int i = 0; i < wall.mesh().n_nodes(); ++i) s.x.col(i) += 10e-6 * Vec3(std::sin(7.0 * i), std::cos(11.0 * i), std::sin(5.0 * i + 1.0));
  wall.refit(s);
  double beside = 0.0;
  for (int k = 0; k < 200; ++k) {
    const double angle = 0.31 * k, radius = 0.45e-3 + 20e-6 * std::sin(3.0 * k);
    const Vec3 q(radius * std::cos(angle), radius * std::sin(angle), 0.3e-3 + 12e-6 * k);
    const WallCrossing near = wall.nearest(s, q, 1e-4);
    ASSERT_TRUE(near.found);
    EXPECT_NEAR(near.away.norm(), 1.0, 1e-9);
    EXPECT_NEAR((wall.on_triangle(s, near.point) + near.fraction * near.away - q).norm(), 0.0, 1e-12);
    EXPECT_GT(near.away.dot(near.normal), 0.0);
    beside = std::max(beside, (wall.position(s, near.point) - wall.on_triangle(s, near.point)).norm());
    const Vec3 a = 1.3 * q - 0.3 * Vec3(0, 0, q.z()), b(0, 0, q.z());
    const WallCrossing c = wall.crossing(s, a, b);
    ASSERT_TRUE(c.found);
    EXPECT_NEAR((wall.on_triangle(s, c.point) - a - c.fraction * (b - a)).norm(), 0.0, 1e-12);
  }
  EXPECT_GT(beside, 2e-6);
}

TEST(VesselWallSurface, NearestTellsInsideFromOutside) {
  VesselWall wall = plain();
  const WallState s = wall.first_state();
  wall.refit(s);
  const WallCrossing outside = wall.nearest(s, Vec3(0.48e-3, 0, 1.5e-3), 1e-4);
  ASSERT_TRUE(outside.found);
  EXPECT_NEAR(outside.fraction, 0.03e-3, 1e-9);
  EXPECT_EQ(outside.surface, WallSurface::outer);
  EXPECT_NEAR(wall.nearest(s, Vec3(0.43e-3, 0, 1.5e-3), 1e-4).fraction, -0.02e-3, 1e-6);
  EXPECT_NEAR(wall.nearest(s, Vec3(0.33e-3, 0, 1.5e-3), 1e-4).fraction, 0.02e-3, 1e-6);  // in the lumen
  EXPECT_FALSE(wall.nearest(s, Vec3(0.6e-3, 0, 1.5e-3), 1e-4).found);
}

/// A search that ends before it has seen all triangles in reach misses the nearest of them.
TEST(VesselWallSurface, TheNearestIsFoundAmongAllThatAreInReach) {
  VesselWall wall = plain();
  const WallState s = wall.first_state();
  wall.refit(s);
  for (int k = 0; k < 40; ++k) {
    const double angle = 0.157 * k;
    const Vec3 q(0.5e-3 * std::cos(angle), 0.5e-3 * std::sin(angle), 0.1e-3 + 70e-6 * k);
    const WallCrossing close = wall.nearest(s, q, 0.1e-3), far = wall.nearest(s, q, 5e-3);
    ASSERT_TRUE(close.found);
    EXPECT_NEAR((wall.position(s, far.point) - wall.position(s, close.point)).norm(), 0.0, 1e-12);
    EXPECT_NEAR(far.fraction, close.fraction, 1e-12);
  }
}

/// Turned by 40 degrees and gone 1 mm on in one step.
WallState flung(const VesselWall& wall, const WallState& from) {
  WallState to = from;
  const Quat turn(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()));
  for (int i = 0; i < wall.mesh().n_nodes(); ++i) to.x.col(i) = turn * Vec3(from.x.col(i)) + Vec3(0.6e-3, -0.8e-3, 0);
  to.v = (to.x - from.x) / wall.options().dt;
  return to;
}

TEST(VesselWallSurface, WhatWasNearestBeforeAStepIsToldAfterIt) {
  VesselWall wall = plain();
  const WallState before = wall.first_state(), now = flung(wall, before);
  const double farthest = wall.options().dt * now.v.colwise().norm().maxCoeff();
  ASSERT_GT(farthest, 1e-3);
  for (int k = 0; k < 40; ++k) {
    const double angle = 0.157 * k, radius = 0.44e-3 + 2e-6 * k;
    const Vec3 q(radius * std::cos(angle), radius * std::sin(angle), 0.1e-3 + 70e-6 * k);
    wall.refit(before);
    const WallCrossing was = wall.nearest(before, q, 0.1e-3);
    wall.refit(now);
    const WallCrossing told = wall.nearest_before(now, q, 0.1e-3, farthest);
    ASSERT_TRUE(was.found && told.found);
    EXPECT_NEAR((wall.position(before, told.point) - wall.position(before, was.point)).norm(), 0.0, 1e-12) << "of two that meet there either";
    EXPECT_NEAR(told.fraction, was.fraction, 1e-12);
    EXPECT_NEAR((told.away - was.away).norm(), 0.0, 1e-6);
  }
}

TEST(VesselWallSurface, NormalsOfASideTurnWithIt) {
  VesselWall wall = plain();
  const WallState before = wall.first_state(), now = flung(wall, before);
  wall.refit(before);
  const WallCrossing c = wall.crossing(before, Vec3(0.4e-3, 0.48e-3, 1.43e-3), Vec3(0, 0, 1.43e-3));
  ASSERT_TRUE(c.found);
  const VesselWall::SideNormals side = wall.side_normals(now, c.point);
  EXPECT_NEAR((side.before - c.normal).norm(), 0.0, 1e-9);
  EXPECT_NEAR((side.now - Quat(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized())) * c.normal).norm(), 0.0, 1e-9);
}

TEST(VesselWallSurface, LocateInvertsPosition) {
  VesselWall wall = plain();
  WallState s = wall.first_state();
  s.x.row(0) *= 1.2;
  const WallPoint at{77, Vec3(0.4, -0.7, 0.2)};
  const WallPoint found = wall.locate(s, wall.position(s, at), {77, Vec3::Zero()});
  EXPECT_LT((found.local - at.local).norm(), 1e-8);
}

TEST(VesselWallSurface, DirectionsAreDerivativesOfPosition) {
  VesselWall wall = plain();
  const WallState s = wall.first_state();
  const WallPoint at{30, Vec3(0.1, 0.5, -0.3)};
  const Mat3 g = wall.directions(s, at);
  for (int c = 0; c < 3; ++c) {
    WallPoint up = at, down = at;
    up.local[c] += 1e-4;
    down.local[c] -= 1e-4;
    EXPECT_LT(((wall.position(s, up) - wall.position(s, down)) / 2e-4 - g.col(c)).norm(), 1e-12);
  }
}

TEST(VesselWallSurface, WhatIsGoneIsNotMet) {
  VesselWall wall = plain();
  WallState s = wall.first_state();
  wall.refit(s);
  const Vec3 a(1e-3, 1e-6, 1.51e-3), b(0, 1e-6, 1.51e-3);
  const WallCrossing c = wall.crossing(s, a, b);
  ASSERT_TRUE(c.found);
  s.soundness[static_cast<std::size_t>(c.point.element)] = 0.0;
  EXPECT_FALSE(wall.crossing(s, a, b).found);
}

}  // namespace vessel_wall_surface_test
