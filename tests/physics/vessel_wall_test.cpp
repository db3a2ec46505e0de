#include "physics/vessel_wall.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>

#include "base/rng.h"
#include "physics/vessel_wall_pressure.h"
#include "physics/vessel_wall_static.h"
#include "tests/allocation_count.h"

using namespace filum;

namespace vessel_wall_test {

std::vector<WallLayer> artery() {
  WallLaw law;
  law.kind = WallLaw::Kind::fibres;
  law.mu = 60e3;
  law.lambda = 3e6;
  law.k1 = 60e3;
  law.k2 = 0.84;
  law.beta = 0.5;
  return {{"media", 6e-5, law}, {"adventitia", 4e-5, law}};
}

TubeShape small_tube() {
  TubeShape s;
  s.around = 12;
  s.along = 6;
  s.length = 1.5e-3;
  return s;
}

VesselWall stump(WallOptions options = {}) { return VesselWall(make_tube(small_tube()), artery(), options); }

/// Pulled slowly by a dead load, the moving wall comes to rest where the equilibrium solver says.
TEST(VesselWall, ComesToRestAtEquilibrium) {
  WallOptions options;
  options.single_precision = false;
  options.tolerance = 1e-8;
  options.max_iterations = 200;
  VesselWall wall = stump(options);
  WallState state = wall.first_state();
  const WallPoint at{5 * 12 + 3, Vec3(0, 1, 0)};
  const Vec3 force(0, 3e-4, 1e-4);
  for (int k = 0; k < 300; ++k) {
    wall.clear_loads();
    wall.add_load(state, at, force);
    ASSERT_TRUE(wall.step(state).converged) << k;
  }
  const VesselMesh mesh = make_tube(small_tube());
  const WallElements elements(mesh, artery());
  WallLoadCase load;
  load.fixed.assign(static_cast<std::size_t>(3 * mesh.n_nodes()), 0);
  for (const int i : mesh.held)
    for (int c = 0; c < 3; ++c) load.fixed[static_cast<std::size_t>(3 * i + c)] = 1;
  load.force = Points::Zero(3, mesh.n_nodes());
  const auto w = corner_weights(at.local);
  for (int a = 0; a < 8; ++a) load.force.col(mesh.elements[static_cast<std::size_t>(at.element)][static_cast<std::size_t>(a)]) += w[a] * force;
  Points x = mesh.nodes;
  ASSERT_TRUE(solve_static(mesh, elements, load, x, 1e-10).converged);
  const double moved = (x - mesh.nodes).cwiseAbs().maxCoeff();
  EXPECT_GT(moved, 5e-5);
  EXPECT_LT((x - state.x).cwiseAbs().maxCoeff(), 2e-3 * moved);
}

/// Stresses of the first shape (stretched, sprung shut) make its matrix indefinite; the wall opens and draws back to its length all the same.
TEST(VesselWall, OpensStretchedAndSprungShut) {
  TubeShape shape = small_tube();
  shape.stretch = 1.2;
  shape.opening_angle = 80.0 * std::numbers::pi / 180.0;
  shape.inner_radius = 0.4e-3 * 360.0 / 280.0;
  std::vector<WallLayer> soft = artery();
  soft[0].law.mu = 35e3;
  soft[0].law.k1 = 40e3;
  soft[1].law.mu = 6e3;
  soft[1].law.k1 = 14e3;
  const VesselMesh mesh = make_tube(shape);
  const Eigen::SelfAdjointEigenSolver<WallElements::Stiffness> eigen(WallElements(mesh, soft).stiffness(0, mesh.nodes, true));
  ASSERT_LT(eigen.eigenvalues()[0], -1e-3 * eigen.eigenvalues()[23]);
  WallOptions options;
  options.max_iterations = 60;
  VesselWall wall(mesh, soft, options);
  WallState state = wall.first_state();
  wall.settle(state, 600);
  EXPECT_TRUE(state.x.allFinite());
  EXPECT_NEAR(state.x.row(2).maxCoeff(), shape.length, 0.05 * shape.length);
}

TEST(VesselWall, TurnsOverWithItsClamp) {
  VesselWall wall = stump();
  WallState state = wall.first_state();
  const Points before = state.x;
  for (int k = 1; k <= 250; ++k) {
    wall.place_clamp(0, {Vec3(1e-6 * k, 0, 0), Quat(Eigen::AngleAxisd(std::numbers::pi * k / 250.0, Vec3::UnitX()))});
    ASSERT_TRUE(wall.step(state).sound);
  }
  for (int k = 0; k < 200; ++k) wall.step(state);
  const Pose X{Vec3(250e-6, 0, 0), Quat(1e-17, 1, 0, 0)};
  for (int i = 0; i < before.cols(); ++i) EXPECT_LT((state.x.col(i) - X * Vec3(before.col(i))).norm(), 2e-6);
}

TEST(VesselWall, PressureWidensTheLumen) {
  VesselWall wall = stump();
  WallState state = wall.first_state();
  double last = lumen_volume(wall.mesh(), 0, state.x);
  for (const double mmhg : {25.0, 50.0, 100.0}) {
    wall.set_pressure(0, mmhg * 133.322);
    for (int k = 0; k < 200; ++k) ASSERT_TRUE(wall.step(state).sound);
    const double now = lumen_volume(wall.mesh(), 0, state.x);
    EXPECT_GT(now, 1.02 * last) << mmhg;
    last = now;
  }
  wall.set_pressure(0, 0.0);
  for (int k = 0; k < 400; ++k) wall.step(state);
  EXPECT_NEAR(lumen_volume(wall.mesh(), 0, state.x) / lumen_volume(wall.mesh(), 0, wall.mesh().nodes), 1.0, 2e-3);
}

WallOptions exact() {
  WallOptions options;
  options.single_precision = false;
  options.tolerance = 1e-8;
  options.max_iterations = 400;
  return options;
}

TEST(WallLateTolerance, IsStrictAtFirstAndGrowsUpToItsLimit) {
  WallOptions o;
  o.tolerance = 1e-5;
  o.strict_iterations = 5;
  EXPECT_DOUBLE_EQ(late_tolerance(o, 4), 1e-5);
  EXPECT_NEAR(late_tolerance(o, 5), 1.6e-5, 1e-12);
  EXPECT_NEAR(late_tolerance(o, 6), 2.56e-5, 1e-12);
  EXPECT_NEAR(late_tolerance(o, 16), 3e-5, 1e-12);
  o.tolerance = 3e-4;
  EXPECT_DOUBLE_EQ(late_tolerance(o, 16), 3e-4) << "never stricter than at first";
  EXPECT_DOUBLE_EQ(late_tolerance(WallOptions(), 24), WallOptions().tolerance) << "not in closed-form problems";
}

/// A step under a dead load leaves the wall where one under something that ends with that force does.
void expect_dead_load_is_same(const WallState& before, const WallState& after, const WallPoint& at, const Vec3& force) {
  VesselWall wall = stump(exact());
  WallState state = before;
  wall.clear_loads();
  ASSERT_TRUE(wall.add_load(state, at, force));
  ASSERT_TRUE(wall.step(state).converged);
  EXPECT_LT((state.x - after.x).cwiseAbs().maxCoeff(), 1e-8);
}

/// Dry friction on a soft wall: stick while the wall follows, its limit while the wall goes the other way.
TEST(VesselWall, FrictionLetsGoWithinTheStep) {
  const WallPoint at{5 * 12 + 3, Vec3(0, 1, 1)};
  WallSlip slip;
  slip.along = Vec3(0, 0.6, 0.8);
  slip.stick = 400.0;
  slip.high = slip.force = 1e-4;
  slip.low = -slip.high;
  for (const double against : {0.0, -3e-4}) {
    VesselWall wall = stump(exact());
    const WallState before = wall.first_state();
    WallState state = before;
    wall.add_load(state, at, against * slip.along, Mat3::Zero(), slip);
    ASSERT_TRUE(wall.step(state).converged);
    const double moved = slip.along.dot(wall.position(state, at) - wall.position(before, at));
    const double held = std::clamp(slip.force - slip.stick * moved, slip.low, slip.high);
    if (against == 0.0) {
      EXPECT_LT(held, 0.5 * slip.high) << "the soft wall follows";
    } else {
      EXPECT_EQ(held, slip.high);
    }
    expect_dead_load_is_same(before, state, at, (against + held) * slip.along);
  }
}

/// What stands against the wall pushes with what is left of its overlap, drags by friction, and does nothing while it is apart.
TEST(VesselWall, APushIsOneSided) {
  const WallPoint at{5 * 12 + 3, Vec3(0, 1, 1)};
  VesselWall wall = stump(exact());
  const WallState before = wall.first_state();
  const Vec3 normal = wall.directions(before, at).col(2).normalized(), side = Vec3::UnitZ();
  WallState state = before;
  const int number = wall.add_push(state, at, {normal, 20e-6, 200.0, 0.02, 50e-6 * side});
  ASSERT_TRUE(wall.step(state).converged);
  const Vec3 moved = wall.position(state, at) - wall.position(before, at), push = wall.push(number);
  EXPECT_GT(-normal.dot(moved), 1e-6);
  EXPECT_NEAR(-normal.dot(push), 200.0 * (20e-6 + normal.dot(moved)), 1e-9);
  EXPECT_GT(side.dot(push), 0.0);
  EXPECT_LE((push - normal.dot(push) * normal).norm(), 0.02 * 200.0 * 20e-6 * (1.0 + 1e-9));
  expect_dead_load_is_same(before, state, at, push);
  wall.clear_loads();
  state = before;
  const int apart = wall.add_push(state, at, {normal, -2e-6, 200.0, 0.02, 50e-6 * side});
  ASSERT_TRUE(wall.step(state).converged);
  EXPECT_EQ(wall.push(apart), Vec3::Zero());
  EXPECT_LT((state.x - before.x).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(VesselWall, SameStateSameLoadsSameBits) {
  VesselWall one = stump(), other = stump();
  WallState a = one.first_state();
  const WallPoint at{40, Vec3(0.3, -0.2, 1)};
  const auto drive = [&](VesselWall& w, WallState& s, int k) {
    w.clear_loads();
    w.add_load(s, at, Vec3(1e-4 * std::sin(0.1 * k), 2e-4, 0), 20.0);
    w.step(s);
  };
  for (int k = 0; k < 20; ++k) drive(one, a, k);
  WallState b = a;
  for (int k = 20; k < 40; ++k) drive(one, a, k);
  for (int k = 20; k < 40; ++k) drive(other, b, k);
  EXPECT_EQ((a.x - b.x).cwiseAbs().maxCoeff(), 0.0);
  EXPECT_EQ((a.v - b.v).cwiseAbs().maxCoeff(), 0.0);
}

/// A wall that has made all steps and one that makes this step only: jerks, friction that sticks and slips, an element that gives way.
TEST(VesselWall, WhatIsRememberedOfTheLastStepChangesNothing) {
  VesselWall one = stump();
  WallState a = one.first_state();
  Rng rng(5);
  for (int k = 0; k < 16; ++k) {
    if (k == 8) a.soundness[20] = 0.3;
    VesselWall fresh = stump();
    WallState b = a;
    std::vector<double> jerk;
    for (int n = 0; n < 9; ++n) jerk.push_back(rng.normal());
    const auto drive = [&](VesselWall& w, WallState& s) {
      w.clear_loads();
      w.add_load(s, {20, Vec3(0, 0, 1)}, 5e-3 * Vec3(jerk[0], jerk[1], jerk[2]));
      for (int n = 0; n < 3; ++n) {
        WallSlip slip;
        slip.along = Vec3(jerk[3], jerk[4], jerk[5]).normalized();
        slip.stick = 200.0;
        slip.high = slip.force = 2e-4;
        slip.low = -slip.high;
        w.add_load(s, {18 + n, Vec3(jerk[6], 0, 1)}, Vec3::Zero(), Mat3::Zero(), slip);
      }
      w.step(s);
    };
    drive(one, a);
    drive(fresh, b);
    ASSERT_EQ((a.x - b.x).cwiseAbs().maxCoeff(), 0.0) << k;
  }
}

TEST(VesselWall, AStepAllocatesNothing) {
  if (!FILUM_COUNTS_ALLOCATIONS) GTEST_SKIP() << "allocations are not counted under sanitizers";
  VesselWall wall = stump();
  WallState state = wall.first_state();
  const WallPoint at{40, Vec3(0.3, -0.2, 1)};
  wall.set_pressure(0, 2000.0);
  wall.step(state);
  const long before = allocations;
  for (int k = 0; k < 20; ++k) {
    wall.clear_loads();
    wall.add_load(state, at, Vec3(0, 3e-4, 0), 20.0);
    wall.refit(state);
    (void)wall.crossing(state, Vec3(-1e-3, 0, 1e-3), Vec3(1e-3, 0, 1e-3));
    (void)wall.nearest(state, Vec3(0.4e-3, 0, 1e-3), 1e-4);
    wall.step(state);
  }
  EXPECT_EQ(allocations, before);
}

/// Steps under random loads of this size [N] and, if wanted, a clamp that jumps by more than the tube's radius; then lets go. Returns how far it is from its first shape [m].
double maltreat(VesselWall& wall, WallState& state, double size, int steps, bool jumps) {
  Rng rng(11);
  for (int k = 0; k < steps; ++k) {
    wall.clear_loads();
    for (int n = 0; n < 4; ++n) {
      const WallPoint at{static_cast<int>(rng.below(72)), Vec3(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1))};
      wall.add_load(state, at, Vec3(rng.normal(), rng.normal(), rng.normal()) * size, 100.0 * rng.uniform());
    }
    if (jumps && k % 50 == 0) wall.place_clamp(0, {Vec3(rng.normal(), rng.normal(), rng.normal()) * 5e-4, Quat(Eigen::AngleAxisd(rng.normal(), Vec3::UnitZ()))});
    const WallSummary r = wall.step(state);
    EXPECT_TRUE(r.sound && state.x.allFinite() && state.v.allFinite()) << k;
  }
  wall.clear_loads();
  for (int k = 0; k < 1000; ++k) wall.step(state);
  const Pose X = state.clamp[0];
  double worst = 0.0;
  for (int i = 0; i < state.x.cols(); ++i) worst = std::max(worst, (state.x.col(i) - X * Vec3(wall.mesh().nodes.col(i))).norm());
  return worst;
}

/// Loads far beyond what tissue bears leave it crumpled for seconds; no number is lost and nothing blows up.
TEST(VesselWall, SurvivesViolentHands) {
  VesselWall wall = stump();
  WallState state = wall.first_state();
  EXPECT_LT(maltreat(wall, state, 2e-2, 400, true), 2e-3);
  EXPECT_LT(state.v.colwise().norm().maxCoeff(), 1e-4);
}

TEST(VesselWall, SpringsBackFromLightHands) {
  VesselWall wall = stump();
  WallState state = wall.first_state();
  EXPECT_LT(maltreat(wall, state, 1e-4, 200, false), 1e-5);
}

TEST(VesselWall, RefusesMoreLoadsThanItHolds) {
  VesselWall wall = stump();
  const WallState state = wall.first_state();
  for (int k = 0; k < VesselWall::kMostLoads; ++k) ASSERT_TRUE(wall.add_load(state, {1, Vec3::Zero()}, Vec3::Zero()));
  EXPECT_FALSE(wall.add_load(state, {1, Vec3::Zero()}, Vec3::Zero()));
  wall.clear_loads();
  EXPECT_FALSE(wall.add_load(state, {}, Vec3::Zero()));
}

}  // namespace vessel_wall_test
