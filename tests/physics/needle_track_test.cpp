#include "physics/needle_track.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "physics/track_rig.h"

namespace filum {
namespace needle_track_test {

constexpr double kMove = 2e-6;

bool drive_until(TrackRig& rig, const std::string& event, double most = 2e-3) {
  for (double s = 0.0; s < most; s += kMove) {
    rig.step(kMove);
    if (event == rig.last_event()) return true;
  }
  return false;
}

TEST(NeedleTrack, PointGoesInAtItsThresholdAndNotBefore) {
  RigOptions o;
  o.track = plain_track(10e-3, 1e-3, 5.0);
  TrackRig rig(o);
  double most = 0.0;
  while (rig.tracks().n == 0 && most < 20e-3) most = std::max(most, rig.step(kMove).force);
  EXPECT_EQ(rig.tracks().n, 1);
  EXPECT_GE(rig.event_force(), 10e-3);
  EXPECT_LT(rig.event_force(), 14e-3);
  EXPECT_NEAR(rig.tracks().tracks[0].bite_entry, o.bite, 12e-6);
  EXPECT_NEAR(rig.tracks().tracks[0].entry_angle, 1.57, 0.02);
}

/// Where there is no room for another way the point does not go in: it is not told to have, and costs nothing.
TEST(NeedleTrack, PointThatCannotGoInIsNotToldToHave) {
  RigOptions o;
  o.track = plain_track(10e-3, 1e-3, 5.0);
  TrackRig rig(o);
  TrackState& s = const_cast<TrackState&>(rig.tracks());
  s.n = kMaxTracks;
  for (NeedleTrack& t : s.tracks) t.ended = 1;
  double most = 0.0;
  for (int k = 0; k < 60; ++k) most = std::max(most, rig.step(kMove).force);
  EXPECT_GT(most, 10e-3);
  EXPECT_EQ(s.n, kMaxTracks);
  EXPECT_STREQ(rig.last_event(), "");
  EXPECT_EQ(s.dissipated, 0.0);
}

TEST(NeedleTrack, FlatNeedleSkidsInsteadOfGoingIn) {
  RigOptions o;
  o.angle = 0.2;  // below the least angle
  o.track = plain_track(3e-3, 1e-3, 5.0);
  TrackRig rig(o);
  for (int k = 0; k < 150; ++k) rig.step(kMove);
  EXPECT_EQ(rig.tracks().n, 0);
}

TEST(NeedleTrack, ForceGrowsByFrictionOverDepthAndTurnsRoundOnTheWayBack) {
  RigOptions o;
  o.track = plain_track(5e-3, 2e-3, 10.0);
  TrackRig rig(o);
  ASSERT_TRUE(drive_until(rig, "puncture"));
  double in = 0.0;
  for (int k = 0; k < 300; ++k) in = rig.step(kMove).force;
  const double depth = rig.inserted();
  EXPECT_GT(depth, 0.4e-3);
  EXPECT_NEAR(in, 2e-3 + 10.0 * depth, 0.05 * in);
  double out = 0.0;
  for (int k = 0; k < 60; ++k) out = rig.step(-kMove).force;
  EXPECT_NEAR(out, -10.0 * rig.inserted(), 0.15 * 10.0 * rig.inserted()) << "friction only: nothing is cut on the way back";
}

TEST(NeedleTrack, DrawnBackItLeavesNoStitch) {
  RigOptions o;
  o.track = plain_track(5e-3, 1e-3, 5.0);
  TrackRig rig(o);
  ASSERT_TRUE(drive_until(rig, "puncture"));
  for (int k = 0; k < 100; ++k) rig.step(kMove);
  for (int k = 0; k < 400; ++k) rig.step(-kMove);
  EXPECT_EQ(rig.tracks().n, 0);
  EXPECT_LT(rig.tracks().open, 0);
}

TEST(NeedleTrack, ComesOutOnTheFarSideAndHoldsTheNeedle) {
  RigOptions o;
  o.thickness = 0.3e-3;
  o.track = plain_track(5e-3, 1e-3, 5.0);
  TrackRig rig(o);
  ASSERT_TRUE(drive_until(rig, "needle-out"));
  for (int k = 0; k < 200; ++k) rig.step(kMove);
  const NeedleTrack& t = rig.tracks().tracks[0];
  EXPECT_EQ(t.out, 1);
  EXPECT_NEAR(t.bite_exit, t.bite_entry, 10e-6);
  EXPECT_NEAR(t.deep - t.shallow, 1.0, 1e-3) << "through the whole thickness";
  EXPECT_NEAR(t.knots[0].strand - t.knots[static_cast<std::size_t>(t.n - 1)].strand, -o.thickness, 0.05 * o.thickness) << "the track keeps the tissue's length";
}

/// A longer way than its knots reach: the last one stands for the rest of it and is where the needle came out.
TEST(NeedleTrack, LastKnotOfALongWayIsItsExit) {
  RigOptions o;
  o.thickness = 1e-3;
  o.track = plain_track(5e-3, 1e-3, 1.0);
  TrackRig rig(o);
  ASSERT_TRUE(drive_until(rig, "needle-out", 3e-3));
  const NeedleTrack& t = rig.tracks().tracks[0];
  ASSERT_EQ(t.n, kTrackKnots);
  const double through = t.knots[kTrackKnots - 1].strand - t.knots[0].strand;
  EXPECT_NEAR(through, o.thickness, 0.05 * o.thickness);
  double spans = 0.0;
  for (const TrackKnot& k : t.knots) spans += k.span;
  EXPECT_NEAR(spans, through, 20e-6) << "up to the give of their friction";
}

TEST(NeedleTrack, SmallBiteTearsAtItsLoadAndLetsGo) {
  RigOptions o;
  o.thickness = 0.3e-3;
  o.bite = 0.15e-3;
  o.track = plain_track(5e-3, 1e-3, 1.0);
  o.track.tear = 100.0;  // 15 mN at this bite
  TrackRig rig(o);
  ASSERT_TRUE(drive_until(rig, "needle-out"));
  double most = 0.0;
  for (int k = 0; k < 1600 && rig.tracks().tracks[0].ended == 0; ++k) {
    rig.step(0.0, 0.25 * kMove);
    most = std::max(most, rig.tracks().tracks[0].pull);
  }
  EXPECT_EQ(rig.tracks().tracks[0].ended, 2);
  EXPECT_NEAR(most, 15e-3, 2e-3);
}

/// Drawn aside by d in a block that does not give, each knot holds by k d (1 + d^2/d_s^2), and straight on from 2 d_s.
TEST(NeedleTrack, HoldStiffensByItsLaw) {
  RigOptions o;
  o.thickness = 0.3e-3;
  o.young = 1e9;
  o.track = plain_track(5e-3, 1e-3, 0.0);
  o.track.hold = 50.0;
  o.track.stiffens = 20e-6;
  o.track.tear = 1e6;
  TrackRig rig(o);
  ASSERT_TRUE(drive_until(rig, "needle-out"));
  const NeedleTrack& t = rig.tracks().tracks[0];
  const auto place = [&](int k) -> Vec3 { return rig.needle().X_WN * rig.shape().point(t.knots[static_cast<std::size_t>(k)].strand); };
  std::vector<Vec3> before;
  for (int k = 0; k < t.n; ++k) before.push_back(place(k));
  const double hold = 50.0, d_s = 20e-6;
  double farthest = 0.0;
  const int all = t.n;  // until it tilts out of one
  for (int step = 1; step <= 400 && t.n == all; ++step) {
    rig.step(0.0, 1e-6);
    if (step % 20 != 0) continue;
    double law = 0.0;
    for (int k = 0; k < t.n; ++k) {
      const double d = (place(k) - before[static_cast<std::size_t>(k)]).norm();
      farthest = std::max(farthest, d);
      law += d < 2.0 * d_s ? hold * d * (1.0 + d * d / (d_s * d_s)) : hold * (10.0 * d_s + 13.0 * (d - 2.0 * d_s));
    }
    EXPECT_NEAR(t.pull, law, 0.02 * law) << step;
  }
  EXPECT_GT(farthest, 2.2 * d_s) << "straight on, too";
}

TEST(NeedleTrack, SawingWidensTheHole) {
  RigOptions o;
  o.thickness = 0.3e-3;
  o.bend_radius = 10e-3;  // a curved needle on a straight way presses against its track
  o.track = plain_track(5e-3, 1e-3, 1.0);
  o.track.wear = 0.1;
  TrackRig rig(o);
  ASSERT_TRUE(drive_until(rig, "needle-out"));
  const double before = rig.tracks().tracks[0].hole;
  for (int k = 0; k < 150; ++k) rig.step(kMove);
  EXPECT_GT(rig.tracks().tracks[0].hole, before);
}

/// The rule of the seed paper, Fig. 4: a node C of the vessel follows the nearest node M_i of the needle, until the spring from its
/// anchor A to M_{i-1} is much longer than that to M_{i+1}; then it goes over to the next node.
int follow_nodes(int i, const Vec3& anchor, const std::vector<Vec3>& needle, double much) {
  while (i > 0 && i + 1 < static_cast<int>(needle.size()) &&
         (needle[static_cast<std::size_t>(i + 1)] - anchor).norm() > much * (needle[static_cast<std::size_t>(i - 1)] - anchor).norm())
    --i;
  return i;
}

/// A needle that looks straight down on a stiff card, its point at a height over the card's face.
class PointOverCard : public testing::Test {
 protected:
  PointOverCard() {
    wall_.refit(w_);
    on_needle_.reserve(8);
    X_WN_.q = Quat::FromTwoVectors(needle_.tangent(needle_.length()), -Vec3::UnitZ());
  }

  void stand_at(double height) { X_WN_.p = Vec3(0.0, -0.3e-3, 0.5 * shape_.thickness + height) - X_WN_.q * needle_.point(needle_.length()); }
  /// As if the point had been seen there in the last step.
  void seen_at(double height) { s_.point_before = Vec3(0.0, -0.3e-3, 0.5 * shape_.thickness + height); }
  double height_seen() const { return s_.point_before.z() - 0.5 * shape_.thickness; }
  /// A step in which the wall pushes the needle's point back by so much [N], if it has met it.
  void follow(double push = 0.0) {
    on_needle_.clear();
    tracks_.hold(wall_, w_, s_, X_WN_, nullptr, on_needle_, on_thread_);
    if (!on_needle_.empty()) on_needle_.back().force = push * Vec3::UnitZ();
    tracks_.follow(wall_, w_, s_, X_WN_, nullptr, 2e-3, on_needle_, on_thread_, events_, 8);
  }
  Vec3 point() const { return X_WN_ * needle_.point(needle_.length()); }
  /// The point stands over the middle of a face of the flat card, and was seen there.
  void stand_over_middle(double height) {
    wall_.refit(w_);
    stand_at(10e-6);
    const WallPoint below = wall_.nearest(w_, point(), 1e-4).point;
    element_ = below.element;
    const Vec3 over = wall_.position(w_, {element_, Vec3(0.0, 0.0, below.local.z())}) + height * Vec3::UnitZ();
    X_WN_.p += over - point();
    s_.point_before = over;
  }
  /// The corners of the element below the point go up or down by so much, each the other way than its neighbours.
  void twist_face(double by) {
    for (const int node : wall_.mesh().elements[static_cast<std::size_t>(element_)]) {
      const Vec3 x = w_.x.col(node) - point();
      w_.x(2, node) += x.x() * x.y() > 0.0 ? by : -by;
    }
    wall_.refit(w_);
  }
  /// The card comes up by so much, and what is near its face with it.
  void lift_card(double by) {
    tracks_.mark_point(wall_, w_, s_);
    w_.x.row(2).array() += by;
    wall_.refit(w_);
    tracks_.carry_point(wall_, w_, s_);
  }

  CardShape shape_;
  VesselWall wall_{make_card(shape_), {{"card", shape_.thickness, WallLaw::hooke(1e6, 0.3)}}, {}};
  WallState w_ = wall_.first_state();
  NeedleShape needle_;
  NeedleTracks tracks_{plain_track(5e-3, 1e-3, 5.0), needle_, wall_};
  TrackState s_;
  Pose X_WN_;
  std::vector<RodTether> on_needle_, on_thread_;
  TrackEvent events_[8];
  int element_ = 0;  // with the face
};

/// A card that is lifted towards a needle standing still, by a third of its thickness and in steps of 4 um: told by the needle's own motion the
/// point would stand within the tissue and be none the wiser.
TEST_F(PointOverCard, WallThatComesUponAPointThatStandsStillMeetsIt) {
  stand_at(10e-6);
  seen_at(10e-6);
  int steps = 0;
  for (; s_.point.kind == PointContact::Kind::none && steps * 4e-6 < shape_.thickness / 3.0; ++steps) {
    follow();
    lift_card(4e-6);
  }
  EXPECT_EQ(s_.point.kind, PointContact::Kind::outside);
  EXPECT_LE(steps, 4) << "10 um away";
}

/// The corners of a face go up and down by turns: its middle stays where it was, the side that its two triangles share does not.
TEST_F(PointOverCard, FaceThatTwistsPastAPointMeetsIt) {
  const WallState flat = w_;
  int met = 0;
  for (const double by : {4e-6, -4e-6}) {
    w_ = flat;
    s_ = {};
    stand_over_middle(1e-6);
    tracks_.mark_point(wall_, w_, s_);
    twist_face(by);
    tracks_.carry_point(wall_, w_, s_);
    const double height = wall_.nearest(w_, point(), 1e-4).fraction;
    follow();
    EXPECT_EQ(s_.point.kind, height < 0.0 ? PointContact::Kind::outside : PointContact::Kind::none) << 1e6 * height << " um";
    met += s_.point.kind == PointContact::Kind::outside ? 1 : 0;
  }
  EXPECT_EQ(met, 1) << "one of the two ways";
}

/// Where a twisted face is not where its corners' mean is, a point that is let go must still be on its outer side.
TEST_F(PointOverCard, PointLetGoAHairWithinATwistedFaceDoesNotPassItUnseen) {
  const WallState flat = w_;
  for (const double by : {4e-6, -4e-6}) {
    w_ = flat;
    s_ = {};
    stand_over_middle(0.0);
    twist_face(by);
    const WallCrossing face = wall_.nearest(w_, point(), 1e-4);
    const auto stand_off = [&](double height) { X_WN_.p += (height - wall_.nearest(w_, point(), 1e-4).fraction) * face.normal; };
    stand_off(5e-6);
    s_.point_before = point();
    stand_off(-2e-6);
    follow();
    ASSERT_EQ(s_.point.kind, PointContact::Kind::outside) << "met on its way down";
    stand_off(-0.05e-6);
    follow(0.0);
    ASSERT_EQ(s_.point.kind, PointContact::Kind::none) << "let go";
    stand_off(-5e-6);
    follow();
    EXPECT_EQ(s_.point.kind, PointContact::Kind::outside) << 1e6 * by << " um";
  }
}

/// A point that is drawn off a face may stand a hair within it by rounding. It was never through, so the next push must meet the face.
TEST_F(PointOverCard, PointLetGoAHairWithinTheWallDoesNotPassItUnseen) {
  seen_at(5e-6);
  stand_at(-2e-6);
  follow();
  ASSERT_EQ(s_.point.kind, PointContact::Kind::outside) << "met on its way down";
  stand_at(-0.05e-6);
  follow(0.0);
  ASSERT_EQ(s_.point.kind, PointContact::Kind::none) << "let go";
  stand_at(-5e-6);
  follow();
  EXPECT_EQ(s_.point.kind, PointContact::Kind::outside);
}

TEST_F(PointOverCard, PointLetGoClearOfTheWallIsFree) {
  seen_at(5e-6);
  stand_at(-2e-6);
  follow();
  ASSERT_EQ(s_.point.kind, PointContact::Kind::outside);
  stand_at(-1e-6);
  follow(1e-3);
  ASSERT_EQ(s_.point.kind, PointContact::Kind::outside) << "held as long as it is pushed back";
  stand_at(20e-6);
  follow(0.0);
  EXPECT_EQ(s_.point.kind, PointContact::Kind::none);
  EXPECT_NEAR(height_seen(), 20e-6, 1e-9) << "where it is, not where the face is";
}

TEST(NeedleTrack, NodeRuleOfTheSeedGoesInStairsTheTrackDoesNot) {
  RigOptions o;
  o.track = plain_track(5e-3, 1e-3, 5.0);
  TrackRig rig(o);
  ASSERT_TRUE(drive_until(rig, "puncture"));
  constexpr int kNodes = 20;
  constexpr double kSpacing = 0.2e-3;
  const double L = kSpacing * (kNodes - 1);
  int node = kNodes - 2;  // the last but one: its two neighbours are compared
  double inserted = 0.0, worst_rule = 0.0, worst_track = 0.0;
  int changes = 0;
  double before = rig.inserted();
  for (int k = 0; k < 350; ++k) {
    rig.step(kMove);
    inserted += kMove;
    std::vector<Vec3> needle;
    for (int i = 0; i < kNodes; ++i) needle.emplace_back(0, 0, -(kSpacing * i - L + kSpacing) - inserted);  // along -z, anchor at 0
    const int next = follow_nodes(node, Vec3::Zero(), needle, 1.5);
    changes += node - next;
    node = next;
    const double by_rule = (kNodes - 2 - node) * kSpacing;
    worst_rule = std::max(worst_rule, std::abs(by_rule - inserted));
    worst_track = std::max(worst_track, std::abs(rig.inserted() - before - inserted));
  }
  EXPECT_GE(changes, 3) << "the vessel's node goes over from needle node to needle node";
  EXPECT_GT(worst_rule, 0.3 * kSpacing) << "what is in the hole jumps by whole needle edges";
  EXPECT_LT(worst_track, 10e-6) << "the track slides continuously, up to the give of its friction";
}

/// A strand drawn through one point of a soft tube takes the wall along as far as its friction can hold it, and then slides: the wall does not swing.
TEST(NeedleTrack, FrictionDragsASoftWallWithoutSwinging) {
  TubeShape shape;
  shape.around = 12;
  shape.along = 6;
  shape.length = 1.5e-3;
  VesselWall wall(make_tube(shape), {{"wall", 1e-4, WallLaw::hooke(60e3, 0.45)}}, {});
  WallState w = wall.first_state();
  const WallPoint at{5 * 12 + 3, Vec3(0, 1, 0)};
  RodTether t;
  t.along = Vec3::UnitZ();
  t.stick = 400.0;
  t.limit = 0.5e-3;
  const double start = wall.position(w, at).z(), dt = wall.options().dt, drawn = 2e-6;
  double stretch = 0.0, before = start, back = 0.0;
  for (int k = 0; k < 60; ++k) {
    stretch += drawn;  // by the strand, then by as much as the wall has followed less
    const double elastic = std::clamp(stretch, -t.limit / t.stick, t.limit / t.stick);
    t.slid = stretch - elastic;
    t.force = -t.stick * elastic * t.along;
    wall.clear_loads();
    load_wall(wall, w, at, t, dt);
    EXPECT_TRUE(wall.step(w).converged) << k;
    const double now = wall.position(w, at).z();
    stretch = elastic - (now - before);
    back = std::min(back, now - before);
    before = now;
  }
  EXPECT_GT(before - start, 5.0 * drawn) << "soft: friction drags it along";
  EXPECT_LT(before - start, 55.0 * drawn) << "and slides in the end";
  EXPECT_GT(back, -0.05 * drawn);
}

}  // namespace needle_track_test
}  // namespace filum
