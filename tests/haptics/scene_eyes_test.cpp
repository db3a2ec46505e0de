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
