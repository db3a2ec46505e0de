#include "devices/pose_track.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace filum {
namespace pose_track_test {

constexpr double kPi = std::numbers::pi;

PoseKey key(double t, Vec3 p, double grip = 0.2) {
  PoseKey k;
  k.t = t;
  k.p_W = p;
  k.grip_angle = grip;
  return k;
}

TEST(PoseTrack, PassesThroughEveryKey) {
  const PoseTrack track(
      1, {key(0, {0, 0, 0}, 0.1), key(1, {1e-3, 2e-3, 3e-3}, 0.3), key(2.5, {4e-3, 1e-3, 0}, 0.0)}, false);
  for (const PoseKey& k : track.keys()) {
    const DeviceSample s = track.at(k.t);
    EXPECT_EQ(s.tool, 1);
    EXPECT_NEAR((s.X_WD.p - k.p_W).norm(), 0.0, 1e-15);
    EXPECT_NEAR(s.grip_angle, k.grip_angle, 1e-15);
  }
}

TEST(PoseTrack, HoldsBeforeAfterAndBetweenEqualKeys) {
  const PoseTrack track(
      0, {key(1, {1e-3, 0, 0}), key(2, {2e-3, 0, 0}), key(3, {2e-3, 0, 0}), key(4, {0, 0, 0})}, false);
  EXPECT_EQ(track.at(-5).X_WD.p, Vec3(1e-3, 0, 0));
  EXPECT_EQ(track.at(99).X_WD.p, Vec3(0, 0, 0));
  for (double t = 2.0; t <= 3.0; t += 0.01) EXPECT_EQ(track.at(t).X_WD.p, Vec3(2e-3, 0, 0)) << t;
}

TEST(PoseTrack, StopBringsTheTipToRestAndASmoothPassDoesNot) {
  for (bool stop : {false, true}) {
    auto keys = std::vector<PoseKey>{key(0, {0, 0, 0}), key(1, {1e-3, 0, 0}), key(2, {2e-3, 0, 0})};
    keys[1].stop = stop;
    const PoseTrack track(0, keys, false);
    const double dt = 1e-5;
    const double speed = (track.at(1 + dt).X_WD.p - track.at(1 - dt).X_WD.p).norm() / (2 * dt);
    if (stop) {
      EXPECT_LT(speed, 1e-7);
    }
    if (!stop) {
      EXPECT_NEAR(speed, 1e-3, 1e-7);
    }
  }
}

// A wrap of 1.25 turns about y: closed form of place and timing, at every moment.
TEST(PoseTrack, ArcFollowsItsClosedForm) {
  auto keys = std::vector<PoseKey>{key(0, {2e-3, 0, 0}), key(2, {0, 1e-3, 3e-3})};
  keys[1].arc = PoseArc{Vec3::Zero(), Vec3::UnitY(), -1.25};
  const PoseTrack track(0, keys, false);
  for (int i = 0; i <= 100; ++i) {
    const double u = i / 100.0;
    const double s = 10 * std::pow(u, 3) - 15 * std::pow(u, 4) + 6 * std::pow(u, 5);
    const double angle = -1.25 * 2 * kPi * s, radius = 2e-3 + 1e-3 * s;
    // Right-handed rotation about y takes x to -z.
    const Vec3 expected(radius * std::cos(angle), 1e-3 * s, -radius * std::sin(angle));
    EXPECT_NEAR((track.at(2 * u).X_WD.p - expected).norm(), 0.0, 1e-15) << "u = " << u;
  }
}

TEST(PoseTrack, ArcEndIsWhereTheArcEnds) {
  const PoseArc arc{Vec3(1e-3, 0, 2e-3), Vec3(1, 2, 2).normalized(), 2.4};
  const Vec3 p0(5e-3, 1e-3, 0);
  const Vec3 p1 = arc_end(arc, p0, 3e-3, 0.5e-3);
  EXPECT_NEAR(axis_distance(arc, p1), 3e-3, 1e-15);
  EXPECT_NEAR((p1 - p0).dot(arc.axis_W), 0.5e-3, 1e-15);
  EXPECT_NEAR(fitting_turns(arc, p0, p1), 2.4, 1e-12);
  EXPECT_NEAR((arc_point(arc, p0, p1, 1.0) - p1).norm(), 0.0, 1e-15);
  EXPECT_NEAR((arc_point(arc, p0, p1, 0.0) - p0).norm(), 0.0, 1e-15);
}

TEST(PoseTrack, NeighboursOfAnArcMeetItAtRest) {
  auto keys = std::vector<PoseKey>{key(0, {0, 0, 0}), key(1, {2e-3, 0, 0}), key(2, {-2e-3, 0, 0}),
                                   key(3, {-9e-3, 0, 0})};
  keys[2].arc = PoseArc{Vec3::Zero(), Vec3::UnitY(), 0.5};
  const PoseTrack track(0, keys, false);
  for (double t : {1.0, 2.0}) {
    const double dt = 1e-5;
    EXPECT_LT((track.at(t + dt).X_WD.p - track.at(t - dt).X_WD.p).norm() / (2 * dt), 1e-6) << t;
  }
}

TEST(PoseTrack, TurnsByTheShortWayWithUnitQuaternions) {
  auto keys = std::vector<PoseKey>{key(0, {0, 0, 0}), key(1, {0, 0, 0})};
  keys[1].q = Quat(Eigen::AngleAxisd(kPi / 2, Vec3::UnitX()));
  const PoseTrack track(0, keys, false);
  EXPECT_NEAR(track.at(0.5).X_WD.q.angularDistance(Quat(Eigen::AngleAxisd(kPi / 4, Vec3::UnitX()))), 0.0,
              1e-9);
  for (double t = 0; t < 1; t += 0.05) EXPECT_NEAR(track.at(t).X_WD.q.norm(), 1.0, 1e-14);
}

TEST(PoseTrack, ButtonsAreHeldFromTheirKeyToTheNext) {
  auto keys = std::vector<PoseKey>{key(0, {0, 0, 0}), key(1, {0, 0, 0}), key(2, {0, 0, 0})};
  keys[1].buttons = 2;
  const PoseTrack track(0, keys, false);
  EXPECT_EQ(track.at(0.99).buttons, 0u);
  EXPECT_EQ(track.at(1.0).buttons, 2u);
  EXPECT_EQ(track.at(1.99).buttons, 2u);
  EXPECT_EQ(track.at(2.0).buttons, 0u);
}

TEST(PoseTrack, SpeedNeverJumps) {
  auto keys =
      std::vector<PoseKey>{key(0, {0, 0, 0}), key(0.7, {3e-3, -1e-3, 2e-3}), key(1.1, {4e-3, 2e-3, 2e-3}),
                           key(2.0, {-4e-3, 2e-3, 2e-3}), key(2.5, {-4e-3, 2e-3, 5e-3})};
  keys[3].arc = PoseArc{Vec3(0, 0, 2e-3), Vec3::UnitY(), 1.5};
  const PoseTrack track(0, keys, false);
  const double dt = 1e-4;
  Vec3 last = Vec3::Zero();
  for (double t = 0.0; t < 2.6; t += dt) {
    const Vec3 v = (track.at(t + dt).X_WD.p - track.at(t).X_WD.p) / dt;
    EXPECT_LT((v - last).norm(), 2e-4) << "at t = " << t;  // bounded acceleration, 2 m/s^2
    last = v;
  }
}

}  // namespace pose_track_test
}  // namespace filum
