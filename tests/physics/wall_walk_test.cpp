#include "physics/wall_walk.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

namespace filum {
namespace wall_walk_test {

std::vector<WallLayer> one_layer(double thickness) { return {{"wall", thickness, WallLaw::hooke(100e3, 0.4)}}; }

/// Eight by four elements of 0.5 x 0.5 x 0.15 mm, from x = -2 mm to 2 mm; the cut edge lies at y = 0.
CardShape small() {
  CardShape shape;
  shape.width = 4e-3;
  shape.depth = 2e-3;
  shape.across = 8;
  shape.deep = 4;
  return shape;
}

struct Card {
  CardShape shape = small();
  VesselWall wall{make_card(shape), one_layer(shape.thickness), {}};
  WallState state = wall.first_state();
  WallWalk walk{wall};
};

/// Six elements along the edge and three across it, in tissue that is turned and stretched.
TEST(WallWalk, GoesFromElementToElementToThePoint) {
  Card c;
  bool inside = false;
  const WallPoint start = c.walk.move(c.wall, c.state, Vec3(-1.6e-3, -0.2e-3, 0.0), {0, Vec3::Zero()}, inside);
  ASSERT_TRUE(inside);
  const Mat3 turn = Eigen::AngleAxisd(0.7, Vec3(1, -2, 2).normalized()).toRotationMatrix() * Vec3(1.2, 0.9, 1.1).asDiagonal();
  c.state.x = turn * c.state.x;
  const Vec3 rest(1.05e-3, -1.7e-3, 0.03e-3), q = turn * rest;
  const WallPoint there = c.walk.move(c.wall, c.state, q, start, inside);
  EXPECT_TRUE(inside);
  EXPECT_NE(there.element, start.element);
  EXPECT_LT((c.wall.position(c.state, there) - q).norm(), 1e-12);
  EXPECT_LT((c.walk.at_rest(c.wall, there) - rest).norm(), 1e-12) << "where it was as first made";
}

/// The last elements round a ring have the first for neighbours.
TEST(WallWalk, GoesOnRoundATube) {
  TubeShape shape;
  shape.around = 8;
  shape.along = 3;
  const VesselWall wall(make_tube(shape), one_layer(shape.thickness), {});
  const WallState state = wall.first_state();
  const WallWalk walk(wall);
  WallPoint at{0, Vec3::Zero()};
  const Vec3 start = wall.position(state, at);
  const double r = start.head<2>().norm(), first = std::atan2(start.y(), start.x());
  for (int k = 1; k <= shape.around; ++k) {
    const double angle = first + 2.0 * M_PI * k / shape.around;
    bool inside = false;
    at = walk.move(wall, state, Vec3(r * std::cos(angle), r * std::sin(angle), start.z()), at, inside);
    ASSERT_TRUE(inside) << k;
    EXPECT_EQ(at.element == 0, k == shape.around) << k;
  }
}

TEST(WallWalk, StopsAtTheBorderAndSaysThatThePointIsBeyond) {
  Card c;
  bool inside = false;
  const WallPoint start = c.walk.move(c.wall, c.state, Vec3(0.1e-3, -0.6e-3, 0.0), {0, Vec3::Zero()}, inside);
  ASSERT_TRUE(inside);
  for (const Vec3& beyond : {Vec3(0.1e-3, -0.6e-3, 0.1e-3), Vec3(0.1e-3, 0.2e-3, 0.0)}) {
    inside = true;
    const WallPoint at = c.walk.move(c.wall, c.state, beyond, start, inside);
    EXPECT_FALSE(inside);
    EXPECT_EQ(at.local.cwiseAbs().maxCoeff(), 1.0);
    const Vec3 last(beyond.x(), std::min(beyond.y(), 0.0), std::min(beyond.z(), 0.5 * c.shape.thickness));
    EXPECT_LT((c.wall.position(c.state, at) - last).norm(), 1e-12);
  }
}

/// A bite is measured in the tissue as first made, from the edge of its own part, however near another edge lies or comes.
TEST(WallWalk, BiteIsTheWayToThePartsOwnCutEdgeAtRest) {
  const CardShape card = small();
  VesselMesh mesh = make_card(card);
  append(mesh, make_card(card), {Vec3(0.0, -0.5e-3, 0.3e-3), Quat(Eigen::AngleAxisd(M_PI, Vec3::UnitZ()))});  // its edge over the first, its body to +y
  const VesselWall wall(mesh, one_layer(card.thickness), {});
  WallState state = wall.first_state();
  const WallWalk walk(wall);
  bool inside = false;
  const WallPoint here = walk.move(wall, state, Vec3(0.2e-3, -0.8e-3, 0.05e-3), {0, Vec3::Zero()}, inside);
  ASSERT_TRUE(inside);
  EXPECT_NEAR(walk.bite(wall, here), 0.8e-3, 1e-12);
  const WallPoint other = walk.move(wall, state, Vec3(0.2e-3, 0.1e-3, 0.3e-3), {wall.mesh().n_elements() / 2, Vec3::Zero()}, inside);
  ASSERT_TRUE(inside);
  EXPECT_NEAR(walk.bite(wall, other), 0.6e-3, 1e-12);
  state.x.row(1) *= 2.0;
  const WallPoint moved = walk.move(wall, state, Vec3(0.2e-3, -1.6e-3, 0.05e-3), here, inside);
  EXPECT_TRUE(inside);
  EXPECT_NEAR(walk.bite(wall, moved), 0.8e-3, 1e-12);
}

TEST(WallWalk, BiteOfTissueWithoutACutEdgeIsInfinite) {
  const CardShape card = small();
  VesselMesh mesh = make_card(card);
  for (WallFace& face : mesh.faces)
    if (face.surface == WallSurface::edge) face.surface = WallSurface::end;
  const VesselWall wall(mesh, one_layer(card.thickness), {});
  EXPECT_TRUE(std::isinf(WallWalk(wall).bite(wall, {0, Vec3::Zero()})));
}

}  // namespace wall_walk_test
}  // namespace filum
