#include "world/vessel_contact.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "base/rng.h"
#include "tests/allocation_count.h"

namespace filum {
namespace vessel_contact_test {

constexpr double kRadius = 0.45e-3;  // [m], outer, of a tube along z whose clamp is at z = 0 and whose cut edge is at 3 mm

VesselWall tube() {
  WallOptions o;
  o.tolerance = 1e-7;  // it follows its clamp at once
  o.max_iterations = 60;
  return VesselWall(make_tube({}), {{"wall", 1e-4, WallLaw::hooke(300e3, 0.45)}}, o);
}

/// Along x, across the tube, its middle at `middle`.
RodState across(const Vec3& middle, int n, double edge) {
  Points nodes(3, n);
  for (int i = 0; i < n; ++i) nodes.col(i) = middle + Vec3((i - 0.5 * (n - 1)) * edge, 0, 0);
  return RodState::from_nodes(nodes, n + 4);
}

/// A thread that two weak springs hold by its ends, and the tube that comes upon it.
struct Draped {
  VesselWall wall = tube();
  WallState w = wall.first_state();
  RodState thread;
  ImplicitRod rod;
  RodMemory memory;
  VesselContact contact;
  TouchState touches;
  TrackState tracks;
  std::array<Vec3, 2> anchor;
  double spring = 1e-3;  // [N/m]
  bool again = false;    // a step that takes the thread through the wall is made again

  explicit Draped(double height)
      : thread(across(Vec3(0, height, 1.5e-3), 31, 0.2e-3)), rod(RodMaterial(), ContactMaterial(), 40), memory(rod.make_memory()), contact(40),
        anchor{thread.x.col(0), thread.x.col(30)} {
    wall.refit(w);
  }

  void step(const Pose& X_WC) {
    RodStepOptions o;
    o.dt = wall.options().dt;
    o.gravity.setZero();
    wall.clear_loads();
    rod.tethers.list.clear();
    for (std::size_t k = 0; k < 2; ++k) {
      RodTether t;
      t.arc = k == 0 ? 0.0 : 6e-3;
      t.anchor = anchor[k];
      t.stiffness = spring * Mat3::Identity();
      rod.tethers.list.push_back(t);
    }
    contact.hold(wall, w, touches, thread, rod.tethers.list);
    const std::optional<RodState> before = again ? std::optional(thread) : std::nullopt;
    rod.step(thread, memory, o);
    for (int k = 0; k < 4 && before && contact.catches(wall, w, touches, tracks, thread, rod.tethers.list); ++k) {
      thread = *before;
      rod.step(thread, memory, o);
    }
    contact.follow(wall, w, touches, tracks, thread, rod.tethers.list);
    wall.place_clamp(0, X_WC);
    wall.step(w);
    wall.refit(w);
    contact.overtake(wall, w, touches, tracks, thread);
  }

  /// [m], by which the tissue overlaps the thread at most, seen from above; the whole vessel where the thread has got into it.
  double overlap() const {
    double worst = 0.0;
    for (double s = 0.0; s <= 30.0; s += 0.25) {
      const int i = std::min(29, static_cast<int>(s));
      const Vec3 x = (1.0 - s + i) * thread.x.col(i) + (s - i) * thread.x.col(i + 1), high = x + Vec3(0, 5e-3, 0);
      const WallCrossing c = wall.crossing(w, high, x);
      if (c.found) worst = std::max(worst, (1.0 - c.fraction) * 5e-3);
    }
    return worst;
  }
};

/// Turned by its clamp about an axis 3.3 mm away, as fast as a clamp is turned over, the tube comes upon a thread at rest and lifts it.
TEST(VesselContact, AWallThatTurnsTakesThreadAtRestAlong) {
  Draped d(kRadius + 40e-6);
  constexpr double kTurn = 1.5 * 2e-3, kArm = 3.3e-3;
  long taken = 0;
  for (int k = 1; k <= 90; ++k) {
    const Quat q(Eigen::AngleAxisd(k * kTurn, Vec3::UnitZ()));
    const long before = allocations;
    d.step({q * Vec3(kArm, 0, 0) - Vec3(kArm, 0, 0), q});
    taken += allocations - before;
    ASSERT_LT(d.overlap(), 20e-6) << "twice what the wall moves in one; step " << k;
  }
  EXPECT_GT(d.thread.x.row(1).maxCoeff(), 0.75e-3) << "lifted from 0.49 mm";
  if (FILUM_COUNTS_ALLOCATIONS) {
    EXPECT_EQ(taken, 0);
  }
}

/// Flung down on it by springs (0.5 m/s, half of the way through the vessel in its first step) the thread comes back to rest upon the wall.
TEST(VesselContact, ThreadFlungAtTheWallComesToRestOnIt) {
  Draped d(kRadius + 1e-6);
  for (Vec3& a : d.anchor) a.y() -= 1.7e-3;
  d.step({});
  ASSERT_LT(d.thread.v.row(1).minCoeff(), -0.5);
  ASSERT_GT(d.overlap(), 0.3e-3);
  for (int k = 0; k < 200; ++k) d.step({});
  EXPECT_LT(d.overlap(), 8e-6);
  double load = 0.0;
  for (int k = 0; k < d.touches.n; ++k) load += d.touches.touches[static_cast<std::size_t>(k)].load;
  const Vec3 pull = d.rod.tethers.list[0].force + d.rod.tethers.list[1].force;
  EXPECT_NEAR(load, -pull.y(), 0.02 * load) << "carries what the springs pull";
}

/// What was flung as far in is out again in a step or two, not by 30 um in each, as far as kDeepest goes: walls move faster than that.
TEST(VesselContact, ThreadThatIsFarInIsOutAtOnce) {
  Draped d(kRadius + 1e-6);
  for (Vec3& a : d.anchor) a.y() -= 1.7e-3;
  d.step({});
  ASSERT_GT(d.overlap(), 0.3e-3);
  for (int k = 0; k < 2; ++k) d.step({});
  EXPECT_LT(d.overlap(), 30e-6);
}

/// A step that takes it through the wall is made again with what holds it there: it never gets in.
TEST(VesselContact, AStepThatTakesThreadThroughIsMadeAgain) {
  Draped d(kRadius + 1e-6);
  d.again = true;
  for (Vec3& a : d.anchor) a.y() -= 1.7e-3;
  for (int k = 0; k < 5; ++k) {
    d.step({});
    EXPECT_LT(d.overlap(), 10e-6) << "step " << k;
  }
}

/// Told of thread that is deeper than half a wall and goes on; not of what is on its way out, nor where the wall pushes it back.
TEST(VesselContact, ThreadThatIsDrawnThroughTheWallIsTold) {
  const auto told = [](double depth, double sinks) {
    Draped d(kRadius - depth + sinks);
    const WallCrossing top = d.wall.crossing(d.w, Vec3(0, 2.0 * kRadius, 1.5e-3), Vec3(0, 0, 1.5e-3));
    d.touches.touches[0] = {3e-3, top.point, top.normal, 0.0, Vec3::Zero(), 0.0};
    d.touches.n = 1;
    d.contact.hold(d.wall, d.w, d.touches, d.thread, d.rod.tethers.list);
    d.thread.x.row(1).array() -= sinks;
    return d.contact.sinks(d.wall, d.w, d.touches, d.thread);
  };
  EXPECT_NEAR(told(60e-6, 12e-6), 12e-6, 0.2e-6) << "faces lie askew by five degrees";
  EXPECT_EQ(told(60e-6, -30e-6), 0.0) << "on its way out";
  EXPECT_EQ(told(40e-6, 12e-6), 0.0) << "where the wall pushes it back";
}

/// Slid along its axis as fast as a clamp slides, the tube carries the thread that lies across it until the springs pull sideways with friction times what
/// they press it on with; from then on it slides through underneath.
TEST(VesselContact, AWallThatSlidesCarriesThreadByFriction) {
  Draped d(kRadius + 1e-6);
  for (int k = 0; k < 500; ++k) {
    for (Vec3& a : d.anchor) a.y() -= 2e-6;
    d.step({});
  }
  for (int k = 0; k < 100; ++k) d.step({});
  ASSERT_GT(d.touches.n, 0);
  const double start = d.thread.x(2, 15);
  const auto slide = [&](int from, int to) {
    for (int k = from + 1; k <= to; ++k) {
      d.step({Vec3(0, 0, 0.5e-3 * 2e-3 * k), Quat::Identity()});
      ASSERT_LT(d.overlap(), 8e-6) << "step " << k;
    }
  };
  slide(0, 80);
  EXPECT_NEAR(d.thread.x(2, 15) - start, 80e-6, 4e-6) << "carried";
  slide(80, 700);
  const Vec3 pull = d.rod.tethers.list[0].force + d.rod.tethers.list[1].force;
  EXPECT_NEAR(pull.z() / pull.y(), d.contact.law.friction, 0.02 * d.contact.law.friction) << "Coulomb";
  EXPECT_LT(d.thread.x(2, 15) - start, 400e-6) << "of 700 um";
}

/// Pulled sideways with half of what friction bears, thread stays where it is for two seconds: it does not creep on by the bristles' bend in each step.
TEST(VesselContact, ThreadThatFrictionHoldsDoesNotCreep) {
  Draped d(kRadius + 1e-6);
  d.spring = 0.02;
  for (int k = 0; k < 500; ++k) {
    for (Vec3& a : d.anchor) a.y() -= 2e-6;
    d.step({});
  }
  const double start = d.thread.x(2, 15);
  const auto slope = [&] {
    const Vec3 pull = d.rod.tethers.list[0].force + d.rod.tethers.list[1].force;
    return pull.z() / std::abs(pull.y());
  };
  for (int k = 0; k < 2000 && slope() < 0.5 * d.contact.law.friction; ++k) {
    for (Vec3& a : d.anchor) a.z() += 1e-6;
    d.step({});
  }
  for (int k = 0; k < 1000; ++k) d.step({});
  EXPECT_NEAR(slope(), 0.5 * d.contact.law.friction, 0.1 * d.contact.law.friction);
  EXPECT_NEAR(d.thread.x(2, 15), start, 2e-6);
}

/// At half a metre a second a wall of 0.1 mm, and the lumen behind it, go past in one step: the thread still is on the side where it was.
TEST(VesselContact, AFastWallDoesNotTunnel) {
  VesselWall wall = tube();
  WallState w = wall.first_state();
  RodState thread = across(Vec3(0, kRadius + 20e-6, 1.5e-3), 31, 0.2e-3);
  VesselContact contact(40);
  const auto pass = [&](const Vec3& by) {
    w = wall.first_state();
    w.x.colwise() += by;
    w.v.colwise() = Vec3(by / wall.options().dt);
    wall.refit(w);
    TouchState touches;
    contact.overtake(wall, w, touches, {}, thread);
    return touches;
  };
  const TouchState up = pass({0, 1e-3, 0});
  ASSERT_GT(up.n, 4);
  for (int k = 0; k < up.n; ++k) {
    const SurfaceTouch& t = up.touches[static_cast<std::size_t>(k)];
    EXPECT_NEAR(wall.depth_at(t.at), 0.0, 1e-9) << "on the outer surface";
    EXPECT_GT(t.normal.y(), 0.0);
  }
  EXPECT_EQ(pass({0, -1e-3, 0}).n, 0) << "away from it";
  EXPECT_EQ(pass({0, 15e-6, 0}).n, 0) << "not there yet";
  thread = across(Vec3(0, 0.4e-3, 3.02e-3), 31, 0.2e-3);
  const TouchState edge = pass({0, 0, 1e-3});
  ASSERT_GT(edge.n, 0);
  EXPECT_GT(edge.touches[0].normal.z(), 0.9) << "on the cut edge";
}

/// A wall that turns as it is flung over thread: what is nearest afterwards came from elsewhere, and from behind it.
TEST(VesselContact, AWallThatTurnsAsItGoesOverThreadIsSeen) {
  VesselWall wall = tube();
  const WallState first = wall.first_state();
  WallState w = first;
  const RodState thread = across(Vec3(0, kRadius + 20e-6, 1.5e-3), 31, 0.2e-3);
  const Quat turn(Eigen::AngleAxisd(0.6, Vec3::UnitX()));
  for (int i = 0; i < wall.mesh().n_nodes(); ++i) w.x.col(i) = turn * Vec3(first.x.col(i) - Vec3(0, 0, 1.5e-3)) + Vec3(0, 0.8e-3, 1.5e-3);
  w.v = (w.x - first.x) / wall.options().dt;
  wall.refit(w);
  VesselContact contact(40);
  TouchState touches;
  contact.overtake(wall, w, touches, {}, thread);
  ASSERT_GT(touches.n, 6);
  for (int k = 0; k < touches.n; ++k) {
    const SurfaceTouch& t = touches.touches[static_cast<std::size_t>(k)];
    EXPECT_NEAR(wall.depth_at(t.at), 0.0, 1e-9) << "on the outer surface";
    EXPECT_GT((turn.inverse() * t.normal).y(), 0.0) << "on the side that it was on";
  }
}

/// Thread in the lumen that came in from outside, and is on its way back: the inner surface does not hold it, neither while it is deep nor in the step in which it comes out.
TEST(VesselContact, WhatComesBackOutIsNotHeldOnItsWay) {
  VesselWall wall = tube();
  const WallState w = wall.first_state();
  wall.refit(w);
  const WallCrossing top = wall.crossing(w, Vec3(0, 2.0 * kRadius, 1.5e-3), Vec3(0, 0, 1.5e-3));
  const auto back = [&](double to, bool known) {
    RodState thread = across(Vec3(0, 0.3e-3, 1.5e-3), 3, 0.15e-3);
    TouchState touches;
    if (known) {
      touches.touches[0] = {0.16e-3, top.point, top.normal, 0.0, Vec3::Zero(), 0.0};
      touches.n = 1;
    }
    VesselContact contact(8);
    std::vector<RodTether> tethers;
    tethers.reserve(8);
    contact.hold(wall, w, touches, thread, tethers);
    thread.x.row(1).array() += to - 0.3e-3;
    contact.follow(wall, w, touches, {}, thread, tethers);
    return touches.n;
  };
  EXPECT_GT(back(0.38e-3, false), 1) << "what has always been in the lumen is held";
  EXPECT_EQ(back(0.38e-3, true), 1) << "deep";
  EXPECT_EQ(back(0.47e-3, true), 0) << "out";
}

TEST(VesselContact, TheWayBackTurnsWithTheWall) {
  VesselWall wall = tube();
  const WallState first = wall.first_state();
  wall.refit(first);
  const WallCrossing top = wall.crossing(first, Vec3(1e-6, 2.0 * kRadius, 1.5e-3), Vec3(1e-6, 0, 1.5e-3));
  const RodState thread = across(Vec3(0, 0.3e-3, 1.5e-3), 3, 0.15e-3);
  TouchState touches;
  touches.touches[0] = {0.15e-3, top.point, top.normal, 0.0, Vec3::Zero(), 0.0};
  touches.n = 1;
  WallState w = first;
  const Quat turn(Eigen::AngleAxisd(0.3, Vec3::UnitX()));
  for (int i = 0; i < wall.mesh().n_nodes(); ++i) w.x.col(i) = turn * Vec3(first.x.col(i) - Vec3(0, 0, 1.5e-3)) + Vec3(0, 0, 1.5e-3);
  w.v = (w.x - first.x) / wall.options().dt;
  wall.refit(w);
  VesselContact contact(8);
  contact.overtake(wall, w, touches, {}, thread);
  EXPECT_NEAR((touches.touches[0].normal - turn * top.normal).norm(), 0.0, 1e-6);
}

/// A touch that has nothing above it is of a strand that has gone round; kept, it would keep others away.
TEST(VesselContact, ATouchWithNothingAboveEnds) {
  VesselWall wall = tube();
  const WallState w = wall.first_state();
  wall.refit(w);
  const WallCrossing top = wall.crossing(w, Vec3(0, 2.0 * kRadius, 1.5e-3), Vec3(0, 0, 1.5e-3));
  RodState thread = across(Vec3(0, 0.3e-3, 4e-3), 3, 0.15e-3);  // a millimetre beyond the cut edge
  TouchState touches;
  touches.touches[0] = {0.15e-3, top.point, top.normal, 0.0, Vec3::Zero(), 0.0};
  touches.n = 1;
  VesselContact contact(8);
  std::vector<RodTether> tethers;
  tethers.reserve(8);
  contact.hold(wall, w, touches, thread, tethers);
  contact.follow(wall, w, touches, {}, thread, tethers);
  EXPECT_EQ(touches.n, 0);
}

/// A thread that leads from the lumen over the cut edge, in edges of 1.2 mm, drawn or passed against the rim.
TEST(VesselContact, ThreadHooksOverARimBetweenItsNodes) {
  VesselWall wall = tube();
  WallState w = wall.first_state();
  wall.refit(w);
  Points nodes(3, 2);
  nodes.col(0) = Vec3(0, 0, 3.02e-3);
  nodes.col(1) = Vec3(0, 1.2e-3, 3.02e-3);
  RodState thread = RodState::from_nodes(nodes, 4);
  VesselContact contact(4);
  std::vector<RodTether> tethers;
  TouchState touches;
  contact.hold(wall, w, touches, thread, tethers);
  thread.x.row(2).array() -= 40e-6;
  contact.follow(wall, w, touches, {}, thread, tethers);
  ASSERT_EQ(touches.n, 1);
  EXPECT_NEAR(touches.touches[0].arc, 0.4e-3, 0.06e-3);
  EXPECT_GT(touches.touches[0].normal.z(), 0.9);
}

/// A jaw lies at rest on the cut edge of a stump whose elements are as long as it is thick. By how much the wall's nodes swing to and fro in a step once it has
/// come to rest: their ways, but for what they get anywhere. [m]
double swing_under_a_jaw(double aside, double beyond, double turn, double deep) {
  WallOptions options;
  options.max_iterations = 60;
  TubeShape shape;
  shape.around = 24;
  shape.along = 18;
  VesselWall wall(make_tube(shape), {{"wall", 1e-4, WallLaw::hooke(300e3, 0.45)}}, options);
  WallState w = wall.first_state();
  VesselContact contact(4);
  const std::vector<InstrumentParameters> tools(1);
  std::vector<InstrumentState> states(1);
  states[0].angle = 0.0;
  states[0].X_WT.q = Quat(Eigen::AngleAxisd(turn, Vec3::UnitY()) * Eigen::AngleAxisd(-0.45 * std::acos(-1.0), Vec3::UnitX()));  // its handle all but flat
  states[0].X_WT.p = Vec3(aside, kRadius + tools[0].tip_radius - deep, 3e-3 + beyond);
  constexpr int kSteps = 500, kWatched = 99;
  Points begin, before;
  Eigen::ArrayXd way = Eigen::ArrayXd::Zero(w.x.cols());
  for (int k = 0; k < kSteps; ++k) {
    wall.refit(w);
    wall.clear_loads();
    contact.press(wall, w, tools, states);
    const bool converged = wall.step(w).converged;
    EXPECT_TRUE(converged || k < kSteps - kWatched) << k;
    if (k == kSteps - kWatched - 1) begin = w.x;
    if (k >= kSteps - kWatched) way += (w.x - before).colwise().norm().transpose().array();
    before = w.x;
  }
  return ((way - (w.x - begin).colwise().norm().transpose().array()) / kWatched).maxCoeff();
}

TEST(VesselContact, AnEdgeUnderAJawLiesStill) {
  Rng rng(11);
  for (int k = 0; k < 12; ++k) {
    const double aside = rng.uniform(-0.2e-3, 0.2e-3), beyond = rng.uniform(-0.2e-3, 0.3e-3), turn = rng.uniform(-1.5, 1.5), deep = rng.uniform(20e-6, 120e-6);
    const double swing = swing_under_a_jaw(aside, beyond, turn, deep);
    EXPECT_LT(swing, 2e-6) << k << ": " << aside << " " << beyond << " " << turn << " " << deep;
  }
}

TEST(VesselContact, NothingIsThereBetweenTwoPieces) {
  VesselWall wall = tube();
  WallState w = wall.first_state();
  RodState thread = across(Vec3(0, kRadius + 20e-6, 1.5e-3), 2, 1.2e-3);
  VesselContact contact(8);
  w.x.row(1).array() += 40e-6;
  w.v.row(1).array() += 40e-6 / wall.options().dt;
  wall.refit(w);
  TouchState whole, cut;
  contact.overtake(wall, w, whole, {}, thread);
  EXPECT_GT(whole.n, 0);
  thread.alive[0] = 0;
  contact.overtake(wall, w, cut, {}, thread);
  EXPECT_EQ(cut.n, 0);
}

}  // namespace vessel_contact_test
}  // namespace filum
