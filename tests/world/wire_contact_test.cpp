#include "world/wire_contact.h"

#include <gtest/gtest.h>

#include "physics/needle.h"
#include "tests/allocation_count.h"

namespace filum {
namespace wire_contact_test {

constexpr double kRadius = 0.45e-3;  // [m], outer, of a tube along z whose clamp is at z = 0 and whose cut edge is at 3 mm

VesselWall tube() {
  WallOptions o;
  o.tolerance = 1e-7;
  o.max_iterations = 60;
  return VesselWall(make_tube({}), {{"wall", 1e-4, WallLaw::hooke(300e3, 0.45)}}, o);
}

/// A needle across the tube, crown down, in a hand: stiff springs at its ends and its middle draw it to where it was first, moved by `drawn`.
struct Laid {
  VesselWall wall = tube();
  WallState w = wall.first_state();
  NeedleBody body{NeedleShape(), 0};
  NeedleState needle;
  NeedleOptions options;
  WireContact contact{NeedleShape()};
  TouchState touches;
  TrackState tracks;
  Pose first;
  Vec3 drawn = Vec3::Zero();
  bool held = true;
  double grip = 1.0;  // share of the hand's stiffness

  /// `gap` [m], between wire and tube.
  explicit Laid(double gap) {
    const NeedleShape& n = body.shape();
    Mat3 turn;
    turn << 0, 1, 0, -1, 0, 0, 0, 0, 1;
    first.q = Quat(turn);
    first.p = Vec3(0, kRadius + n.wire_radius + gap, 1.5e-3) - turn * n.point(0.5 * n.length());
    needle.X_WN = first;
    options.gravity.setZero();
    options.dt = wall.options().dt;
    wall.refit(w);
  }

  void step() {
    wall.clear_loads();
    body.tethers.clear();
    for (const auto& [share, spring] : {std::pair(0.0, 100.0), std::pair(0.5, 500.0), std::pair(1.0, 100.0)}) {  // [N/m]
      RodTether t;
      t.arc = share * body.shape().length();
      t.anchor = first * body.shape().point(t.arc) + drawn;
      t.stiffness = grip * spring * Mat3::Identity();
      body.tethers.push_back(t);
    }
    contact.hold(wall, w, touches, tracks, needle.X_WN, held, body.tethers);
    body.step(needle, options);
    contact.follow(wall, w, touches, tracks, needle.X_WN, held, body.tethers);
    wall.step(w);
    wall.refit(w);
    contact.feel(wall, touches);
    contact.overtake(wall, w, touches, tracks, needle.X_WN);
  }
  void steps(int n) {
    for (int k = 0; k < n; ++k) step();
  }

  Vec3 pull() const { return body.tethers[0].force + body.tethers[1].force + body.tethers[2].force; }  // [N], of the springs
  Vec3 push() const {  // [N], of the wall on the needle
    Vec3 sum = Vec3::Zero();
    for (int k = 0; k < touches.n; ++k) sum += touches.touches[static_cast<std::size_t>(k)].push;
    return sum;
  }
  /// [m], by which the wire goes into the wall at most, seen from above; the whole vessel where it has got into it.
  double overlap() const {
    const NeedleShape& n = body.shape();
    double worst = 0.0;
    for (double a = 0.2 * n.length(); a < 0.8 * n.length(); a += 20e-6) {
      const Vec3 x = needle.X_WN * n.point(a) - Vec3(0, n.wire_radius, 0), high = x + Vec3(0, 5e-3, 0);
      const WallCrossing c = wall.crossing(w, high, x);
      if (c.found) worst = std::max(worst, (1.0 - c.fraction) * 5e-3);
    }
    return worst;
  }
};

TEST(WireContact, PressedOnAVesselItRestsOnItAndDentsIt) {
  Laid d(2e-6);
  long taken = 0;
  for (int k = 0; k < 500; ++k) {
    if (k < 100) d.drawn.y() -= 2e-6;
    const long before = allocations;
    d.step();
    taken += allocations - before;
    ASSERT_LT(d.overlap(), 20e-6) << "step " << k;
  }
  EXPECT_GT(d.push().y(), 1e-4);
  EXPECT_NEAR(d.push().y(), -d.pull().y(), 0.02 * d.push().y()) << "the hand bears what the wall does";
  EXPECT_LT((d.needle.X_WN.p - d.first.p).y(), -150e-6) << "the wall gives way";
  if (FILUM_COUNTS_ALLOCATIONS) {
    EXPECT_EQ(taken, 0);
  }
}

/// Led to and fro by 1 mm in a step, 0.5 m/s, it goes through the vessel's upper wall at once, and is on the outside of it again where the hand has led it back to.
TEST(WireContact, FlungAtTheVesselItDoesNotGoThrough) {
  Laid d(2e-6);
  d.drawn.y() = -1e-3;
  d.step();
  ASSERT_GT(d.overlap(), 0.3e-3);
  d.steps(3);
  d.drawn.y() = -0.1e-3;
  d.steps(100);
  EXPECT_LT(d.overlap(), 20e-6);
  Laid slow(2e-6);
  for (int k = 0; k < 100; ++k) {
    slow.drawn.y() -= 1e-6;
    slow.step();
  }
  slow.steps(50);
  EXPECT_NEAR(d.push().y(), slow.push().y(), 0.05 * slow.push().y()) << "pressed as if it had come there slowly";
}

/// Drawn along the vessel and back: half the difference of what the hand bears at the same place is friction; the dent's slope is in both.
TEST(WireContact, DrawnAlongTheVesselItSlidesByCoulombsLaw) {
  Laid d(2e-6);
  d.drawn.y() = -0.05e-3;
  d.steps(100);
  const auto draw = [&](int n, double way) {
    for (int k = 0; k < n; ++k) {
      d.drawn.z() += way;
      d.step();
    }
    return d.pull();
  };
  draw(100, 1e-6);
  const Vec3 there = draw(100, 1e-6);
  draw(100, 1e-6);
  const Vec3 back = draw(100, -1e-6);
  const double across = -0.5 * (there + back).y();
  EXPECT_NEAR(0.5 * (there - back).z(), d.contact.law.friction * across, 0.03 * d.contact.law.friction * across);
}

TEST(WireContact, LiftedItComesOffWithoutAPull) {
  Laid d(2e-6);
  d.drawn.y() = -0.15e-3;
  d.steps(200);
  ASSERT_GT(d.touches.n, 0);
  for (int k = 0; k < 300; ++k) {
    d.drawn.y() += 1e-6;
    d.step();
    ASSERT_LT(d.pull().y(), 1e-6) << "step " << k;
  }
  d.steps(50);
  EXPECT_EQ(d.touches.n, 0);
}

/// A loose one, a hundred-thousandth of the hand's springs about it, stays on the vessel, where it trembles (two micrometres: it stands on one place and sways); without the wall it would have
/// fallen by its weight over their stiffness, 0.18 mm.
TEST(WireContact, LooseItLiesOnTheVessel) {
  Laid d(2e-6);
  d.held = false;
  d.options.gravity = Vec3(0, -9.81, 0);
  d.grip = 1e-5;
  d.needle.X_WN.p.y() -= 1e-6;
  d.steps(400);
  double low = 1.0, high = -1.0;
  for (int k = 0; k < 200; ++k) {
    d.step();
    ASSERT_GT(d.touches.n, 0);
    low = std::min(low, d.needle.X_WN.p.y());
    high = std::max(high, d.needle.X_WN.p.y());
  }
  EXPECT_LT(high - low, 5e-6);
  EXPECT_GT(low - d.first.p.y(), -10e-6);
  EXPECT_LT(d.overlap(), 0.1 * d.body.shape().wire_radius);
}

/// Told of a needle that is deeper than half a wall and goes on; not of one on its way out, nor where the wall pushes it back.
TEST(WireContact, ALooseNeedleThatIsPressedThroughTheWallIsTold) {
  const auto told = [](double depth, double sinks) {
    Laid d(0.0);
    const double down = d.body.shape().wire_radius + depth - sinks;  // of its axis below the top
    d.needle.X_WN.p.y() -= down;
    const WallCrossing top = d.wall.crossing(d.w, Vec3(0, 2.0 * kRadius, 1.5e-3), Vec3(0, 0, 1.5e-3));
    d.touches.touches[0] = {0.5 * d.body.shape().length(), top.point, top.normal, 0.0, Vec3::Zero(), 0.0};
    d.touches.n = 1;
    d.contact.hold(d.wall, d.w, d.touches, d.tracks, d.needle.X_WN, false, d.body.tethers);
    d.needle.X_WN.p.y() -= sinks;
    return d.contact.sinks(d.wall, d.w, d.touches, d.needle.X_WN);
  };
  EXPECT_NEAR(told(60e-6, 12e-6), 12e-6, 0.2e-6) << "faces lie askew by five degrees";
  EXPECT_EQ(told(60e-6, -30e-6), 0.0) << "on its way out";
  EXPECT_EQ(told(40e-6, 12e-6), 0.0) << "where the wall pushes it back";
}

/// The wall comes upon a needle at rest: at half a metre a second, past it in one step, or so slowly that it only comes to lie beside it.
TEST(WireContact, AWallThatComesUponItIsNoticed) {
  Laid d(20e-6);
  const auto pass = [&](const Vec3& by) {
    d.w = d.wall.first_state();
    d.w.x.colwise() += by;
    d.w.v.colwise() = Vec3(by / d.wall.options().dt);
    d.wall.refit(d.w);
    TouchState touches;
    d.contact.overtake(d.wall, d.w, touches, {}, d.needle.X_WN);
    return touches;
  };
  const TouchState fast = pass({0, 1e-3, 0});
  ASSERT_GT(fast.n, 4);
  for (int k = 0; k < fast.n; ++k) EXPECT_NEAR(d.wall.depth_at(fast.touches[static_cast<std::size_t>(k)].at), 0.0, 1e-9) << "on the outer surface";
  EXPECT_GT(pass({0, 25e-6, 0}).n, 0) << "by its radius";
  EXPECT_EQ(pass({0, 10e-6, 0}).n, 0) << "not there yet";
  EXPECT_EQ(pass({0, -1e-3, 0}).n, 0) << "away from it";
}

/// Where the tissue holds the needle already nothing touches: 0.3 mm about a track, and all before an open one's entry.
TEST(WireContact, WhereATrackHoldsItNothingIsLookedFor) {
  Laid d(0.0);
  const double L = d.body.shape().length(), middle = 0.5 * L;
  const auto touched = [&](double entry, double exit, bool open) {
    d.tracks.n = 1;
    d.tracks.open = open ? 0 : -1;
    NeedleTrack& t = d.tracks.tracks[0];
    t.n = 2;
    t.knots[0].strand = entry;
    t.knots[1].strand = exit;
    TouchState touches;
    d.w.x.row(1).array() += 30e-6;
    d.wall.refit(d.w);
    d.contact.overtake(d.wall, d.w, touches, d.tracks, d.needle.X_WN);
    d.w.x.row(1).array() -= 30e-6;
    return touches.n;
  };
  EXPECT_EQ(touched(middle - 0.1e-3, middle + 0.1e-3, false), 0);
  EXPECT_GT(touched(middle + 0.8e-3, middle + 1.0e-3, false), 0);
  EXPECT_EQ(touched(middle - 1.0e-3, middle - 0.8e-3, true), 0) << "the point is in it";
  EXPECT_GT(touched(-2e-3, -1.8e-3, false), 0) << "that one holds thread";
}

}  // namespace wire_contact_test
}  // namespace filum
