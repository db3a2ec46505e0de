#include "world/stray_thread.h"

#include <gtest/gtest.h>

#include <cmath>

#include "physics/thread_grasp.h"
#include "tests/allocation_count.h"
#include "world/vessel_contact.h"

namespace filum {
namespace stray_thread_test {

constexpr double kThick = 0.1e-3;                       // [m]
constexpr double kOuter = 0.45e-3, kMiddle = 0.4e-3;    // [m], radii of a tube along z, open at 3 mm

struct Tube {
  VesselWall wall{make_tube({}), {{"wall", kThick, WallLaw::hooke(300e3, 0.45)}}, {}};
  WallState w = wall.first_state();
  StrayThread stray{kThick};
  TouchState touches;
  TrackState tracks;
  StrayState strays;

  Tube() { wall.refit(w); }
  int look(const RodState& thread) {
    int given = 0;
    for (int k = 0; k < 5; ++k) given += stray.step(wall, w, tracks, thread, strays, touches);
    return given;
  }
  int lead_out(const RodState& thread) {
    look(thread);
    return look(thread);
  }
  const SurfaceTouch& touch(int k) const { return touches.touches[static_cast<std::size_t>(k)]; }
};

RodState straight(const Vec3& from, const Vec3& to, int n) {
  Points nodes(3, n);
  for (int i = 0; i < n; ++i) nodes.col(i) = from + static_cast<double>(i) / (n - 1) * (to - from);
  return RodState::from_nodes(nodes, n + 4);
}

/// Through the outer half of the wall, on a chord: at its deepest half way through.
RodState chord() { return straight({-2e-3, kMiddle, 1.5e-3}, {2e-3, kMiddle, 1.5e-3}, 21); }
/// Along the middle of the wall, inside it with both ends.
RodState within() { return straight({0, kMiddle, 0.5e-3}, {0, kMiddle, 2.5e-3}, 21); }

TEST(StrayThread, WhatIsDeepIsDrawnOutWhereTheThreadComesOut) {
  Tube t;
  ASSERT_GT(t.lead_out(chord()), 1);
  for (int k = 0; k < t.touches.n; ++k) {
    EXPECT_GT(t.touch(k).normal.y(), 0.8) << k;
    EXPECT_LT(std::abs(t.touch(k).arc - 2e-3), 0.2e-3) << k;  // the chord is 0.41 mm long
    EXPECT_NEAR(t.wall.on_triangle(t.w, t.touch(k).at).head<2>().norm(), kOuter, 0.03e-3) << k;
  }
  EXPECT_EQ(t.lead_out(chord()), 0) << "they have their touches";
}

TEST(StrayThread, WhatIsSeenOnceIsLeftAlone) {
  Tube t;
  EXPECT_EQ(t.look(chord()), 0);
  EXPECT_EQ(t.look(straight({-2e-3, kOuter + 20e-6, 1.5e-3}, {2e-3, kOuter + 20e-6, 1.5e-3}, 21)), 0);
  EXPECT_EQ(t.look(chord()), 0) << "it has been out in between";
  EXPECT_GT(t.look(chord()), 0);
}

/// A cut end in the wall: the thread comes out of the cut edge of the tube.
TEST(StrayThread, AnEndInTheTissueIsDrawnOutWhereTheThreadComesOut) {
  Tube t;
  ASSERT_GT(t.lead_out(straight({0, kMiddle, 2.6e-3}, {0, kMiddle, 5e-3}, 25)), 2);
  for (int k = 0; k < t.touches.n; ++k) {
    EXPECT_LT(t.touch(k).arc, 0.4e-3) << k;
    EXPECT_GT(t.touch(k).normal.z(), 0.9) << k;
  }
}

TEST(StrayThread, WhatCrossesTheWallAtRightAnglesIsSeen) {
  Tube t;
  ASSERT_GT(t.lead_out(straight({0, 0.1e-3, 1.5e-3}, {0, 1.1e-3, 1.5e-3}, 11)), 0);
  for (int k = 0; k < t.touches.n; ++k) EXPECT_GT(t.touch(0).normal.dot(t.touch(k).normal), 0.9) << "all of a stretch goes out on one side";
}

TEST(StrayThread, WhatLiesOnTheSurfaceIsLeftAlone) {
  Tube t;
  EXPECT_EQ(t.lead_out(straight({0, kOuter - 20e-6, 0.5e-3}, {0, kOuter - 20e-6, 4e-3}, 31)), 0);
  EXPECT_EQ(t.lead_out(straight({-2e-3, kOuter + 20e-6, 1.5e-3}, {2e-3, kOuter + 20e-6, 1.5e-3}, 21)), 0);
}

/// Beside the cut edge, which is nearest: behind it lies the length of the tube.
TEST(StrayThread, WhatCutsAcrossARimIsLeftAlone) {
  for (const double from_edge : {32e-6, 300e-6}) {
    Tube t;
    const double z = 3e-3 - from_edge, y = kOuter - 33e-6;
    EXPECT_EQ(t.lead_out(straight({-2e-3, y, z}, {2e-3, y, z}, 21)) > 0, from_edge > 0.1e-3) << from_edge;
  }
}

/// Its stretch has no other end: the mouth alone tells where it came from.
TEST(StrayThread, WhatIsDraggedOutOfATrackIsDrawnOutAtItsMouth) {
  Tube t;
  const RodState thread = within();
  EXPECT_EQ(t.lead_out(thread), 0) << "nothing tells where it came in";
  for (const double radius : {kOuter, 0.35e-3}) {
    NeedleTrack& track = t.tracks.tracks[0];
    track.n = 2;
    track.knots[0].at = track.knots[1].at = t.wall.nearest(t.w, {0, radius, 1e-3}, 0.1e-3).point;
    track.knots[0].strand = -1.6e-3;
    track.knots[1].strand = -1.5e-3;  // 0.4 to 0.5 mm along the thread
    t.tracks.n = 1;
    t.touches.n = 0;
    t.strays = {};
    ASSERT_GT(t.lead_out(thread), 5);
    for (int k = 0; k < t.touches.n; ++k) {
      EXPECT_GT(std::abs(t.touch(k).arc - 0.45e-3), 0.05e-3 + kTrackReach) << "left alone where the track holds it";
      EXPECT_GT(t.touch(k).normal.y() * (radius == kOuter ? 1.0 : -1.0), 0.9) << radius;
    }
  }
}

TEST(StrayThread, WhatPushesTheOtherWayEnds) {
  Tube t;
  const RodState thread = chord();
  t.touches.n = 2;
  for (std::size_t k = 0; k < 2; ++k) {  // one draws it into the lumen, one, farther above, out
    const double side = k == 0 ? -1.0 : 1.0;
    t.touches.touches[k].arc = 1.98e-3 + 0.05e-3 * static_cast<double>(k);
    t.touches.touches[k].normal = {0, side, 0};
    t.touches.touches[k].at = t.wall.nearest(t.w, {0, kMiddle + side * 40e-6, 1.5e-3}, 0.1e-3).point;
  }
  t.touches.touches[0].arc = 1.9e-3;
  t.lead_out(thread);
  ASSERT_GT(t.touches.n, 0);
  for (int k = 1; k < t.touches.n; ++k) EXPECT_GT(t.touch(0).normal.dot(t.touch(k).normal), 0.5) << k;
}

TEST(StrayThread, LooksWithoutAllocating) {
  Tube t;
  const RodState thread = chord();
  t.lead_out(thread);
  t.touches.n = 0;
  const long before = allocations;
  const int given = t.look(thread);
  EXPECT_EQ(allocations, before);
  EXPECT_GT(given, 0);
}

/// Thread that has got into the wall, which no touch has seen, is out of it within a tenth of a second; without being led it stays.
TEST(StrayThread, IsOutOfTheWallSoon) {
  for (const bool led : {false, true}) {
    Tube t;
    RodState thread = chord();
    ImplicitRod rod(RodMaterial(), ContactMaterial(), 40);
    RodMemory memory = rod.make_memory();
    VesselContact contact(40);
    RodStepOptions o;
    o.dt = t.wall.options().dt;
    o.gravity.setZero();
    for (int k = 0; k < 50; ++k) {
      t.wall.clear_loads();
      rod.tethers.list.clear();
      contact.hold(t.wall, t.w, t.touches, thread, rod.tethers.list);
      rod.step(thread, memory, o);
      contact.follow(t.wall, t.w, t.touches, t.tracks, thread, rod.tethers.list);
      t.wall.step(t.w);
      t.wall.refit(t.w);
      contact.overtake(t.wall, t.w, t.touches, t.tracks, thread);
      if (led) t.stray.step(t.wall, t.w, t.tracks, thread, t.strays, t.touches);
    }
    const WallCrossing near = t.wall.nearest(t.w, at_arc(thread, 2e-3), 1e-3);
    ASSERT_TRUE(near.found);
    if (led)
      EXPECT_GT(near.fraction, -5e-6);
    else
      EXPECT_LT(near.fraction, -30e-6);
  }
}

}  // namespace stray_thread_test
}  // namespace filum
