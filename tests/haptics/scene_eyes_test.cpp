#include "haptics/scene_eyes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace filum {
namespace scene_eyes_test {

struct Scene {
  Observation o;
  SceneDescription d;
  SceneEyes eyes{o, d};
  Pose seen;

  Scene() {  // a thread along x, 5 mm in five edges, that ends straight up
    o.n_nodes = 6;
    o.positions = Points::Zero(3, 8);
    o.arc.assign(8, 0.0);
    for (int k = 0; k < 6; ++k) {
      o.positions.col(k) = k < 5 ? Vec3(1e-3 * k, 0, 0) : Vec3(4e-3, 0, 1e-3);
      o.arc[static_cast<std::size_t>(k)] = 2e-3 + 1e-3 * k;  // its first 2 mm are no longer there
    }
    o.n_tools = 2;
    o.tools[1].X_WT.p = Vec3(1, 2, 3);
  }
};

TEST(SceneEyes, ThreadIsFoundByItsLengthFromEitherEnd) {
  Scene s;
  ASSERT_TRUE(s.eyes.find({.kind = Look::Kind::thread, .length = 1.25e-3, .from_end = true}, s.seen));
  EXPECT_NEAR((s.seen.p - Vec3(1.25e-3, 0, 0)).norm(), 0.0, 1e-15);
  EXPECT_NEAR((s.seen.q * Vec3::UnitX() - Vec3::UnitX()).norm(), 0.0, 1e-14) << "towards the swage";
  EXPECT_NEAR((s.seen.q * Vec3::UnitZ() - Vec3::UnitZ()).norm(), 0.0, 1e-14);
  ASSERT_TRUE(s.eyes.find({.kind = Look::Kind::thread, .length = 0.5e-3}, s.seen));
  EXPECT_NEAR((s.seen.p - Vec3(4e-3, 0, 0.5e-3)).norm(), 0.0, 1e-15);
  EXPECT_NEAR((s.seen.q * Vec3::UnitX() - Vec3::UnitZ()).norm(), 0.0, 1e-14) << "upright thread still has axes";
  EXPECT_NEAR(s.seen.q.norm(), 1.0, 1e-15);
  EXPECT_FALSE(s.eyes.find({.kind = Look::Kind::thread, .length = 5.1e-3}, s.seen)) << "longer than the thread";
  ASSERT_TRUE(s.eyes.find({.kind = Look::Kind::thread, .length = 0.5e-3, .scene_axes = true}, s.seen));
  EXPECT_EQ(s.seen.q.coeffs(), Quat::Identity().coeffs());
}

TEST(SceneEyes, TheFreeEndIsTheOneThatIsLeftAfterACut) {
  Scene s;
  s.o.cut_edge_low = 1;
  ASSERT_TRUE(s.eyes.find({.kind = Look::Kind::thread, .length = 0.0, .from_end = true}, s.seen));
  EXPECT_NEAR((s.seen.p - Vec3(2e-3, 0, 0)).norm(), 0.0, 1e-15);
}

TEST(SceneEyes, OfAThreadCutInPiecesTheOneOnTheNeedleIsMeant) {
  Scene s;
  s.o.needle.present = true;
  s.o.n_parted = 2;
  s.o.parted = {0, 2};
  s.o.cut_edge_low = 0;
  ASSERT_TRUE(s.eyes.find({.kind = Look::Kind::thread, .length = 0.0, .from_end = true}, s.seen));
  EXPECT_NEAR((s.seen.p - Vec3(3e-3, 0, 0)).norm(), 0.0, 1e-15);
}

TEST(SceneEyes, APullIsFeltByItsOwnToolOnly) {
  Scene s;
  s.o.tools[1].f_T_W = Vec3(3e-3, 0, -4e-3);
  EXPECT_DOUBLE_EQ(s.eyes.felt(1), 5e-3);
  EXPECT_EQ(s.eyes.felt(0), 0.0);
  s.o.tools[2].f_T_W = Vec3(1, 0, 0);
  EXPECT_EQ(s.eyes.felt(2), 0.0) << "there is no third tool";
  EXPECT_EQ(s.eyes.felt(-1), 0.0);
}

TEST(SceneEyes, AKnotBeginsWhereTheStrandFirstComesNearItself) {
  // along x to 2 mm, round a square of 1 mm back to that place, 30 um above it, and on along x
  Scene s;
  const Vec3 way[] = {{0, 0, 0}, {1e-3, 0, 0}, {2e-3, 0, 0}, {3e-3, 0, 0}, {3e-3, 1e-3, 0}, {2e-3, 1e-3, 0}, {2e-3, 0.03e-3, 0.03e-3}, {2e-3, -1e-3, 0}, {2e-3, -2e-3, 0}};
  s.o.n_nodes = 9;
  s.o.radius = 15e-6;
  s.o.positions = Points::Zero(3, 9);
  s.o.arc.assign(9, 0.0);
  for (int k = 0; k < 9; ++k) {
    s.o.positions.col(k) = way[k];
    if (k > 0) s.o.arc[static_cast<std::size_t>(k)] = s.o.arc[static_cast<std::size_t>(k - 1)] + (way[k] - way[k - 1]).norm();
  }
  ASSERT_TRUE(s.eyes.find({.kind = Look::Kind::knot, .length = 0.5e-3, .from_end = true}, s.seen));
  EXPECT_NEAR((s.seen.p - Vec3(1.5e-3, 0, 0)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((s.seen.q * Vec3::UnitX() - Vec3::UnitX()).norm(), 0.0, 1e-12) << "towards the swage";
  ASSERT_TRUE(s.eyes.find({.kind = Look::Kind::knot, .length = 1.0e-3}, s.seen));
  EXPECT_LT((s.seen.p - Vec3(2e-3, -0.97e-3, 0)).norm(), 0.03e-3);
  EXPECT_FALSE(s.eyes.find({.kind = Look::Kind::knot, .length = 2.5e-3, .from_end = true}, s.seen)) << "the strand is shorter";
  s.o.positions.col(6) += Vec3(0, 0, 0.1e-3);
  EXPECT_FALSE(s.eyes.find({.kind = Look::Kind::knot, .from_end = true}, s.seen)) << "nothing is near";
}

TEST(SceneEyes, OfACutEdgeTheTopIsSeenWhereTheVesselsAxisRunsBelow) {
  // two stumps along y, 1 mm apart, each a ring of four at its cut (outer rim turned by 30 degrees, inner rim below it) and one further off
  Scene s;
  TissueDescription& t = s.d.tissue;
  t.lumen = true;
  t.thickness = 0.1e-3;
  t.rest = Points::Zero(3, 24);
  const auto ring = [&](int first, double y, double radius) {
    for (int k = 0; k < 4; ++k) {
      const double turn = std::numbers::pi * (k / 2.0 + 1.0 / 6.0);
      t.rest.col(first + k) = Vec3(radius * std::cos(turn), y, radius * std::sin(turn));
    }
  };
  for (int side = 0; side < 2; ++side) {
    const double out = side == 0 ? -1.0 : 1.0;
    ring(12 * side, 0.5e-3 * out, 0.5e-3);
    ring(12 * side + 4, 0.5e-3 * out, 0.4e-3);
    ring(12 * side + 8, 1.0e-3 * out, 0.5e-3);
  }
  s.o.tissue.positions = t.rest;
  const SceneEyes eyes(s.o, s.d);
  const double top = 0.5e-3 * std::sin(std::numbers::pi / 6.0) + 0.5e-3 * std::cos(std::numbers::pi / 6.0) * std::tan(std::numbers::pi / 12.0);
  for (int side = 0; side < 2; ++side) {
    ASSERT_TRUE(eyes.find({.kind = Look::Kind::edge, .index = side}, s.seen));
    EXPECT_NEAR((s.seen.p - Vec3(0, side == 0 ? -0.5e-3 : 0.5e-3, top)).norm(), 0.0, 1e-12);
    EXPECT_EQ(s.seen.q.coeffs(), Quat::Identity().coeffs());
  }
  s.o.tissue.positions.col(12) += Vec3(0, 0.2e-3, 0);  // as the edge goes, not as it was at rest
  s.o.tissue.positions.col(13) += Vec3(0, 0.2e-3, 0);
  ASSERT_TRUE(eyes.find({.kind = Look::Kind::edge, .index = 1}, s.seen));
  EXPECT_NEAR(s.seen.p.y(), 0.7e-3, 1e-12);
  EXPECT_FALSE(s.eyes.find({.kind = Look::Kind::edge, .index = 0}, s.seen)) << "of a scene without a vessel";
}

TEST(SceneEyes, NeedlesFrameFollowsItsCurve) {
  Scene s;
  EXPECT_FALSE(s.eyes.find({.kind = Look::Kind::needle}, s.seen)) << "there is none";
  s.o.needle.present = true;
  s.d.needle.bend_radius = 1.6e-3;
  s.d.needle.angle = 0.75 * std::numbers::pi;
  const double length = s.d.needle.bend_radius * s.d.needle.angle, c = std::sin(0.375 * std::numbers::pi) / (0.375 * std::numbers::pi);
  ASSERT_TRUE(s.eyes.find({.kind = Look::Kind::needle, .length = 0.5 * length}, s.seen));
  EXPECT_NEAR((s.seen.p - Vec3(1.6e-3 * (1.0 - c), 0, 0)).norm(), 0.0, 1e-15) << "the arc's middle is on +x";
  ASSERT_TRUE(s.eyes.find({.kind = Look::Kind::needle, .length = length}, s.seen));
  EXPECT_GT(s.seen.p.y(), 0.0) << "the point is on the side of +y";
  Pose back;
  ASSERT_TRUE(s.eyes.find({.kind = Look::Kind::needle, .length = length - 1e-7}, back));
  EXPECT_NEAR(((s.seen.p - back.p).normalized() - s.seen.q * Vec3::UnitY()).norm(), 0.0, 1e-4) << "y runs to the point";
  EXPECT_FALSE(s.eyes.find({.kind = Look::Kind::needle, .length = length + 1e-6}, s.seen));
  EXPECT_FALSE(s.eyes.find({.kind = Look::Kind::needle, .holder = 1}, s.seen)) << "nobody holds it";
  s.o.needle.held[1] = true;
  EXPECT_TRUE(s.eyes.find({.kind = Look::Kind::needle, .holder = 1}, s.seen));
}

TEST(SceneEyes, WaysThroughTissueAreSeenOnceTheyAreThere) {
  Scene s;
  EXPECT_FALSE(s.eyes.find({.kind = Look::Kind::entry}, s.seen));
  s.o.tissue.n_passes = 1;
  s.o.tissue.passes[0].entry_W = Vec3(1, 0, 0);
  s.o.tissue.passes[0].exit_W = Vec3(0, 1, 0);
  ASSERT_TRUE(s.eyes.find({.kind = Look::Kind::entry}, s.seen));
  EXPECT_EQ(s.seen.p, Vec3(1, 0, 0));
  EXPECT_FALSE(s.eyes.find({.kind = Look::Kind::exit}, s.seen)) << "the point is still inside";
  s.o.tissue.passes[0].out = true;
  ASSERT_TRUE(s.eyes.find({.kind = Look::Kind::exit}, s.seen));
  EXPECT_EQ(s.seen.p, Vec3(0, 1, 0));
  ASSERT_TRUE(s.eyes.find({.kind = Look::Kind::tool, .index = 1}, s.seen));
  EXPECT_EQ(s.seen.p, Vec3(1, 2, 3));
  EXPECT_FALSE(s.eyes.find({.kind = Look::Kind::tool, .index = 2}, s.seen));
  EXPECT_TRUE(s.eyes.find({}, s.seen));
  EXPECT_EQ(s.seen.p, Vec3::Zero());
}

}  // namespace scene_eyes_test
}  // namespace filum
