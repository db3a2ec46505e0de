#include "world/surface_touch.h"

#include <gtest/gtest.h>

#include <cmath>

namespace filum {
namespace surface_touch_test {

constexpr double kFold = 0.1;       // [-], slope of both sides of the valley, along x, whose bottom is the line x = 0 on top of a card
constexpr double kDepth = 1e-6;     // [m], of the strand below the bottom
constexpr double kPress = 0.2e-3;   // [N]

struct Valley {
  VesselWall wall;
  WallState w;

  explicit Valley(double fold = kFold) : wall(card(), {{"wall", 0.15e-3, WallLaw::hooke(300e3, 0.45)}}, {}), w(wall.first_state()) {
    for (int i = 0; i < wall.mesh().n_nodes(); ++i) w.x(2, i) += fold * std::abs(w.x(0, i));
    wall.refit(w);
  }
  static VesselMesh card() {
    CardShape shape;
    shape.width = 4e-3;
    shape.depth = 4e-3;
    shape.across = 4;
    shape.deep = 4;
    return make_card(shape);
  }
  /// `beside` [m] the bottom, half way along it.
  Vec3 below(double beside, double along = 0.0) const { return {beside, -2e-3 + along, 0.075e-3 - kDepth}; }
};

/// A wedge of places below the bottom of a valley has its nearest point on the bottom itself: the normal there turns from one side's to the other's.
TEST(SurfaceTouch, InAFoldTheNormalIsTheDistancesGradient) {
  const Valley v;
  SurfaceTouch touch;
  touch.at = v.wall.nearest(v.w, v.below(0.0), 1e-4).point;
  TouchLaw law;
  for (const double share : {-0.9, -0.5, 0.3, 0.8}) {
    const double beside = share * kFold * kDepth;  // the wedge is kFold * depth wide either way
    const TouchFooting f = find_footing(v.wall, v.w, touch, RodTether(), law, v.below(beside));
    ASSERT_TRUE(f.slides);
    EXPECT_NEAR(f.normal.x(), -beside / std::hypot(beside, kDepth), 1e-6);
    EXPECT_NEAR(f.normal.y(), 0.0, 1e-6);
    EXPECT_NEAR(f.depth, std::hypot(beside, kDepth), 1e-12);
  }
  const TouchFooting side = find_footing(v.wall, v.w, touch, RodTether(), law, v.below(0.05e-3) + Vec3(0, 0, kFold * 0.05e-3));
  EXPECT_NEAR(side.normal.x(), -kFold / std::hypot(1.0, kFold), 1e-9);  // that of the face
}

/// What is drawn along a valley is held back along it, and by nothing else: friction turns against the way within some lengths of a bristle.
TEST(SurfaceTouch, FrictionInAFoldTurnsAgainstTheWay) {
  const Valley v;
  TouchLaw law;
  law.friction = 0.3;
  law.stiffness = kPress / kDepth;
  SurfaceTouch touch;
  touch.at = v.wall.nearest(v.w, v.below(0.0), 1e-4).point;
  touch.load = kPress;
  const double bristle = law.friction * kPress / law.stiffness;
  Vec3 x = v.below(bristle);  // it bears all that it can, across the valley
  for (int step = 0; step < 200; ++step) {
    x.y() += 0.1 * bristle;
    RodTether t = hold_touch(v.wall, v.w, touch, law, x);
    const Vec3 d = x - t.anchor, slip = d.dot(t.along) * t.along + d.dot(t.across) * t.across;
    t.force = -t.stiffness * d - slip * std::min(t.stick, t.limit / slip.norm());
    if (step == 199) {
      const Vec3 n = t.along.cross(t.across), rub = t.force - t.force.dot(n) * n;
      EXPECT_NEAR(rub.norm(), law.friction * kPress, 1e-9);
      EXPECT_GT(-rub.y() / rub.norm(), 0.99);
    }
    slide_touch(touch, find_footing(v.wall, v.w, touch, t, law, x));
  }
}

/// A strand that slides down one side of a steep valley and through the other is above the plane it stood on, and still not out: the other side hides it.
TEST(SurfaceTouch, WhatHasSlidThroughTheOtherSideOfAFoldIsNotOut) {
  const Valley v(1.0);
  SurfaceTouch touch;
  touch.at = v.wall.nearest(v.w, Vec3(-0.5e-3, -2e-3, 0.575e-3), 1e-4).point;
  touch.normal = Vec3(1, 0, 1).normalized();
  const Vec3 above(0.2e-3, -2e-3, 0.9e-3), through(1.0e-3, -2e-3, 0.7e-3);  // the other side is 0.15 mm thick and has its top at 0.275 and 1.075 mm there
  EXPECT_TRUE(find_footing(v.wall, v.w, touch, RodTether(), TouchLaw(), above).off);
  const TouchFooting f = find_footing(v.wall, v.w, touch, RodTether(), TouchLaw(), through);
  ASSERT_FALSE(f.off);
  EXPECT_NEAR((f.normal - Vec3(-1, 0, 1).normalized()).norm(), 0.0, 1e-6);
  EXPECT_GT(f.depth, 0.15e-3);
  slide_touch(touch, f);
  EXPECT_GT(v.wall.on_triangle(v.w, touch.at).x(), 0.0) << "from now on it is pushed out of the other side";
}

/// Drawn over the card's rim and down beside it: below the plane of its place, and in nobody's way.
TEST(SurfaceTouch, WhatHasGoneRoundARimIsFree) {
  const Valley v(0.0);
  SurfaceTouch touch;
  touch.at = v.wall.nearest(v.w, Vec3(0.5e-3, -1e-6, 0.075e-3), 1e-4).point;  // the cut edge is at y = 0
  touch.normal = Vec3::UnitZ();
  const auto stands = [&](double beyond, double deep) { return find_footing(v.wall, v.w, touch, RodTether(), TouchLaw(), Vec3(0.5e-3, beyond, 0.075e-3 - deep)); };
  EXPECT_TRUE(stands(50e-6, 30e-6).off) << "beside the edge, and seen from its place";
  EXPECT_FALSE(stands(10e-6, 30e-6).off) << "behind the rim";
  EXPECT_TRUE(stands(0.3e-3, 30e-6).off) << "far from anything";
  EXPECT_FALSE(stands(-10e-6, 30e-6).off) << "within";
  EXPECT_FALSE(stands(10e-6, 60e-6).off) << "deep: what drew it there may be the far side";
}

/// The place of what went through a card goes along over it, on the side that it came from, where the far side is nearer; it turns with the card.
TEST(SurfaceTouch, WhatIsDeepIsDrawnBackTheWayItCame) {
  const Valley v(0.0);
  SurfaceTouch touch;
  touch.at = v.wall.nearest(v.w, Vec3(-0.4e-3, -2e-3, 0.075e-3), 1e-4).point;
  touch.normal = Vec3::UnitZ();
  const Vec3 x(0.6e-3, -1.5e-3, -0.2e-3);  // 0.125 mm below the far side
  const TouchFooting f = find_footing(v.wall, v.w, touch, RodTether(), TouchLaw(), x);
  EXPECT_TRUE(f.deep);
  EXPECT_FALSE(f.slides || f.off);
  ASSERT_TRUE(stay_above(v.wall, v.w, touch, x));
  EXPECT_NEAR((v.wall.on_triangle(v.w, touch.at) - Vec3(0.6e-3, -1.5e-3, 0.075e-3)).norm(), 0.0, 1e-9);
  EXPECT_FALSE(stay_above(v.wall, v.w, touch, Vec3(0.6e-3, 0.5e-3, -0.2e-3))) << "beyond the edge";
  EXPECT_FALSE(stay_above(v.wall, v.w, touch, Vec3(0.6e-3, -1.5e-3, -1.2e-3))) << "too far below";

  WallState turned = v.w;
  const Quat turn(Eigen::AngleAxisd(0.5, Vec3::UnitY()));
  for (int i = 0; i < v.wall.mesh().n_nodes(); ++i) turned.x.col(i) = turn * Vec3(v.w.x.col(i));
  turned.v = (turned.x - v.w.x) / v.wall.options().dt;
  touch.normal = Vec3(0.3, 0.0, 1.0).normalized();
  turn_touch(v.wall, turned, touch);
  EXPECT_NEAR((touch.normal - turn * Vec3(0.3, 0.0, 1.0).normalized()).norm(), 0.0, 1e-9);
}

/// Far in, the force is that of kDeepest, and leads all the way out.
TEST(SurfaceTouch, WhatIsFarInIsDrawnAllTheWayOut) {
  const Valley v(0.0);
  SurfaceTouch touch;
  touch.at = v.wall.nearest(v.w, Vec3(0.1e-3, -2e-3, 0.075e-3), 1e-4).point;
  touch.normal = Vec3::UnitZ();
  const TouchLaw law;
  for (const double depth : {0.5 * kDeepest, 5.0 * kDeepest}) {
    const Vec3 x(0.1e-3, -2e-3, 0.075e-3 - depth);
    const RodTether t = hold_touch(v.wall, v.w, touch, law, x);
    EXPECT_NEAR((t.stiffness * (t.anchor - x)).z(), law.stiffness * std::min(depth, kDeepest), 1e-9);
    EXPECT_NEAR(t.anchor.z(), 0.075e-3, 1e-12);
  }
}

}  // namespace surface_touch_test
}  // namespace filum
