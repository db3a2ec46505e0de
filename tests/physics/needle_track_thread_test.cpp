// Thread that runs through a track: its way, its order, its ends.
#include "physics/needle_track.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "physics/rod_pieces.h"
#include "physics/track_rig.h"

namespace filum {
namespace needle_track_thread_test {

/// A thread held by one knot of a card.
struct HeldByOneKnot {
  explicit HeldByOneKnot(const Points& x) : wall(make_card({}), {{"card", 0.5e-3, WallLaw::hooke(1e6, 0.3)}}, {}), tracks(plain_track(5e-3, 1e-3, 5.0), {}, wall), w(wall.first_state()) {
    thread = RodState::from_nodes(x, static_cast<int>(x.cols()));
    on_thread.reserve(1);
    s.n = 1;
    s.tracks[0].n = 1;
    s.tracks[0].knots[0].at.element = 0;
  }

  VesselWall wall;
  NeedleTracks tracks;
  WallState w;
  RodState thread;
  TrackState s;
  std::vector<RodTether> on_needle, on_thread;
};

/// One with a corner.
struct CornerInTrack : HeldByOneKnot {
  CornerInTrack() : HeldByOneKnot(corner()) {}
  static Points corner() {
    Points x(3, 5);
    for (int i = 0; i < 5; ++i) x.col(i) = i <= 2 ? Vec3(i * kEdge, 0.0, 0.0) : Vec3(2.0 * kEdge, (i - 2) * kEdge, 0.0);
    return x;
  }
  Vec3 along(double arc) {
    s.tracks[0].knots[0].strand = arc - 4.0 * kEdge;
    on_thread.clear();
    tracks.hold(wall, w, s, {}, &thread, on_needle, on_thread);
    return on_thread.at(0).along;
  }

  static constexpr double kEdge = 0.1e-3;
};

TEST(NeedleTrack, RingSeesAStrandTurnRoundItsCornersNotLeap) {
  CornerInTrack c;
  const double h = CornerInTrack::kEdge;
  EXPECT_TRUE(c.along(1.5 * h).isApprox(Vec3::UnitX(), 1e-9)) << "in the middle of an edge it runs as the edge does";
  EXPECT_TRUE(c.along(2.5 * h).isApprox(Vec3::UnitY(), 1e-9));
  EXPECT_TRUE(c.along(2.0 * h).isApprox(Vec3(1.0, 1.0, 0.0).normalized(), 1e-6));
  double most = 0.0, turned = 0.0;
  Vec3 before = c.along(1.4 * h);
  for (double arc = 1.41 * h; arc < 2.6 * h; arc += 0.01 * h) {
    const Vec3 now = c.along(arc);
    EXPECT_NEAR(now.norm(), 1.0, 1e-12);
    const double angle = std::acos(std::min(1.0, now.dot(before)));
    most = std::max(most, angle);
    turned += angle;
    before = now;
  }
  EXPECT_NEAR(turned, 0.5 * std::numbers::pi, 1e-3) << "one way all along";
  EXPECT_LT(most, 0.03) << "[rad], in 1 um";
}

TEST(NeedleTrack, RingAtAnEndOrACutSeesTheEdgeItIsOn) {
  CornerInTrack c;
  const double h = CornerInTrack::kEdge;
  EXPECT_TRUE(c.along(0.1 * h).isApprox(Vec3::UnitX(), 1e-9));
  EXPECT_TRUE(c.along(3.9 * h).isApprox(Vec3::UnitY(), 1e-9));
  c.thread.alive[2] = 0;
  EXPECT_TRUE(c.along(1.9 * h).isApprox(Vec3::UnitX(), 1e-9));
  EXPECT_TRUE(c.along(2.1 * h).isApprox(Vec3::UnitY(), 1e-9));
}

/// Three knots of one track, through which friction has let the thread slide by so much each.
struct SlidInTrack : CornerInTrack {
  SlidInTrack() {
    on_thread.reserve(3);
    s.tracks[0].n = 3;
    for (int k = 0; k < 3; ++k) s.tracks[0].knots[static_cast<std::size_t>(k)] = {{0, Vec3::Zero()}, (k - 3) * kGap, kGap, 0.0};
  }
  std::array<double, 3> after(const std::array<double, 3>& slid) {
    on_thread.clear();
    tracks.hold(wall, w, s, {}, &thread, on_needle, on_thread);
    for (std::size_t k = 0; k < 3; ++k) {
      on_thread.at(k).slid = slid[k];
      on_thread[k].force = Vec3(0.0, 0.0, 1e-3);
      limit = on_thread[k].limit;
    }
    TrackEvent events[4];
    tracks.follow(wall, w, s, {}, &thread, 2e-3, on_needle, on_thread, events, 4);
    return {s.tracks[0].knots[0].strand, s.tracks[0].knots[1].strand, s.tracks[0].knots[2].strand};
  }

  static constexpr double kGap = 60e-6;
  double limit = 0.0;
};

TEST(NeedleTrack, WhatRunsThroughItKeepsItsOrder) {
  constexpr double g = SlidInTrack::kGap;
  EXPECT_EQ(SlidInTrack().after({10e-6, -20e-6, -30e-6}), (std::array{-3 * g - 10e-6, -2 * g + 20e-6, -g + 30e-6})) << "in order already: as friction let it";
  const auto two = SlidInTrack().after({0.0, 50e-6, 190e-6});
  EXPECT_DOUBLE_EQ(two[0], -3 * g - 20e-6) << "the second and the third would be up to 70 um behind the first: all three in the middle";
  EXPECT_DOUBLE_EQ(two[1], two[0]);
  EXPECT_DOUBLE_EQ(two[2], two[0]);
  const auto last = SlidInTrack().after({0.0, -30e-6, 70e-6});
  EXPECT_EQ(last[0], -3 * g) << "who is in order stays";
  EXPECT_DOUBLE_EQ(last[1], -1.5 * g - 20e-6);
  EXPECT_DOUBLE_EQ(last[2], last[1]);
}

TEST(NeedleTrack, WearsAndCostsByWhatWasDrawnThroughInTheEnd) {
  SlidInTrack c;
  c.after({0.0, -60e-6, 60e-6});  // two change places: both in the middle, by 30 um each
  EXPECT_NEAR(c.s.dissipated, c.limit * 60e-6, 1e-3 * c.limit * 60e-6);
}

/// A straight thread of 20 edges through one knot of a card.
struct DrawnThroughTrack : HeldByOneKnot {
  DrawnThroughTrack() : HeldByOneKnot(straight()) { s.tracks[0].out = 1; }
  static Points straight() {
    Points x(3, 21);
    for (int i = 0; i < 21; ++i) x.col(i) = Vec3(i * 0.5e-3, 0.0, 0.0);
    return x;
  }
  double whole() const { return arc_of_node(thread, thread.n - 1); }
  double arc() const { return whole() + s.tracks[0].knots[0].strand; }
  void put_at(double arc) { s.tracks[0].knots[0].strand = arc - whole(); }
  /// Steps in each of which the thread goes on by so much [m]: towards its needle, or back. Whether it is out in the end.
  bool drawn_out(double by, int steps) {
    for (int k = 0; k < steps && s.tracks[0].ended == 0; ++k) {
      on_thread.clear();
      tracks.hold(wall, w, s, {}, &thread, on_needle, on_thread);
      on_thread.at(0).slid = by;
      TrackEvent events[4];
      tracks.follow(wall, w, s, {}, &thread, 2e-3, on_needle, on_thread, events, 4);
    }
    return s.tracks[0].ended == 1;
  }
};

TEST(NeedleTrack, AThreadDrawnOutOfItLeavesItAtItsEndAndNotBefore) {
  DrawnThroughTrack d;
  d.put_at(2e-3);
  EXPECT_FALSE(d.drawn_out(0.1e-3, 19));
  EXPECT_TRUE(d.drawn_out(0.1e-3, 2));
}

/// As after a fresh suture has taken the first piece away (rod_pieces.h: arc_start tells what is gone).
TEST(NeedleTrack, AThreadThatBeginsAtAnArcLeavesItThere) {
  DrawnThroughTrack d;
  d.thread.arc_start = 50e-3;
  d.put_at(52e-3);
  EXPECT_TRUE(d.drawn_out(0.1e-3, 30)) << "the thread begins at 50 mm, the track holds it at " << 1e3 * d.arc() << " mm";
}

/// A suture behind the piece of the one before: nodes 0 to 9 are tied elsewhere, 10 to 20 are drawn right out.
TEST(NeedleTrack, ALaterSutureDrawnOutOfItDoesNotDrawTheOneBeforeIn) {
  DrawnThroughTrack d;
  d.thread.alive[9] = 0;
  d.put_at(arc_of_node(d.thread, 10) + 1e-3);
  EXPECT_TRUE(d.drawn_out(0.1e-3, 30)) << "the suture begins at 5 mm, the track holds the other one at " << 1e3 * d.arc() << " mm";
}

/// Cut between track and needle, and drawn back by its short end: what is left on the needle must not be drawn in after it.
TEST(NeedleTrack, ACutThreadDrawnBackOutOfItLeavesIt) {
  DrawnThroughTrack d;
  d.thread.alive[9] = 0;
  d.put_at(arc_of_node(d.thread, 9) - 1e-3);
  EXPECT_TRUE(d.drawn_out(-0.1e-3, 30)) << "the piece ends at 4.5 mm, the track holds what hangs on the needle at " << 1e3 * d.arc() << " mm";
}

/// In a track of several knots those ahead of the end hold on, and the first of them is the first that is left.
TEST(NeedleTrack, AThreadsEndLeavesOneKnotAfterTheOther) {
  SlidInTrack c;
  NeedleTrack& t = c.s.tracks[0];
  t.knots[0].strand = -4.0 * SlidInTrack::kEdge + 10e-6;
  c.after({20e-6, 0.0, 0.0});
  EXPECT_EQ(t.ended, 0);
  ASSERT_EQ(t.n, 2);
  EXPECT_DOUBLE_EQ(t.knots[0].strand, -2.0 * SlidInTrack::kGap);
}

}  // namespace needle_track_thread_test
}  // namespace filum
