#include "physics/pellet.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace filum {
namespace pellet_test {

constexpr double kDt = 2e-3;  // [s]

/// One pair of jaws that does exactly what it is told, over one object.
struct Bench {
  std::vector<InstrumentParameters> tools{1};
  std::vector<InstrumentState> states{1};
  std::vector<PelletState> pellets;
  std::vector<Vec3> force{Vec3::Zero()};
  Pellets effect;
  std::vector<std::string> said;

  explicit Bench(PelletParameters p = {}) : effect({p}, 0.0) {
    pellets = effect.start();
    states[0].X_WT.p = pellets[0].p;
    states[0].angle = 0.3;
  }
  void step(double grip_angle, double measured = -1.0) {
    std::vector<InstrumentCommand> commands{{states[0].X_WT, grip_angle, measured, measured >= 0.0, true}};
    effect.limit_jaws(tools, states, pellets, commands);
    states[0].angle = std::max(0.0, commands[0].grip_angle);
    states[0].grip_force = commands[0].has_grip_force ? commands[0].grip_force : 0.0;
    force[0].setZero();
    PelletEvent events[8];
    const int n = effect.step(tools, states, kDt, pellets, force, events, 8);
    for (int k = 0; k < n; ++k) said.emplace_back(events[k].name);
  }
};

TEST(Pellet, TwoSpringsInSeriesCarryTheSameForce) {
  const PelletParameters p;
  Bench bench(p);
  const double command = 0.02;
  bench.step(command);
  const InstrumentParameters& tool = bench.tools[0];
  const double n = bench.states[0].grip_force, theta = bench.states[0].angle;
  EXPECT_GT(n, 0.0);
  EXPECT_NEAR(n, tool.grip_stiffness * (theta - command) / tool.jaw_length, 1e-12) << "the grip's spring";
  EXPECT_NEAR(n, p.stiffness * (2.0 * p.radius - theta * tool.jaw_length), 1e-12) << "the object";
}

TEST(Pellet, AMeasuredSqueezeIsTakenAsItIs) {
  Bench bench;
  bench.step(0.02, 0.123);
  EXPECT_EQ(bench.states[0].grip_force, 0.123);
  EXPECT_EQ(bench.pellets[0].holder, 0);
}

TEST(Pellet, ComesOffJustAboveTheSlipLimitAndSlipsJustBelow) {
  const PelletParameters p;
  for (const double share : {0.97, 1.03}) {
    Bench bench(p);
    for (int k = 0; k < 10; ++k) bench.step(0.02, share * p.slip_limit());
    for (int k = 0; k < 400; ++k) {
      bench.states[0].X_WT.p.z() += 2e-6;  // 1 mm/s upwards
      bench.step(0.02, share * p.slip_limit());
    }
    const bool held = share > 1.0;
    EXPECT_EQ(bench.pellets[0].holder, held ? 0 : -1);
    EXPECT_EQ(bench.said.back(), held ? "object-taken" : "object-slipped");
    EXPECT_EQ(bench.pellets[0].p.z() > p.radius + 0.5e-3, held);
  }
}

TEST(Pellet, BreaksAboveItsStrengthOnly) {
  const PelletParameters p;
  Bench gentle(p), rough(p);
  for (int k = 0; k < 10; ++k) gentle.step(0.02, 0.99 * p.strength), rough.step(0.02, 1.01 * p.strength);
  EXPECT_EQ(gentle.pellets[0].broken, 0);
  EXPECT_EQ(rough.pellets[0].broken, 1);
  EXPECT_EQ(rough.said[1], "object-broken");
}

TEST(Pellet, TheToolFeelsThePullThatTheSheetHasOnTheObject) {
  const PelletParameters p;
  Bench bench(p);
  bench.step(0.02, 0.3);
  bench.states[0].X_WT.p.z() += 0.1e-3;
  bench.step(0.02, 0.3);
  EXPECT_NEAR(bench.force[0].z(), -p.shear * 0.1e-3, 1e-12);
  EXPECT_EQ(bench.pellets[0].stuck, 1);
  bench.states[0].X_WT.p.z() += 0.1e-3;  // 40 mN is more than the adhesion of 30 mN
  bench.step(0.02, 0.3);
  EXPECT_EQ(bench.pellets[0].stuck, 0);
}

TEST(Pellet, LetGoItFallsAndSticksWhereItLands) {
  const PelletParameters p;
  Bench bench(p);
  for (int k = 0; k < 10; ++k) bench.step(0.02, 0.3);
  for (int k = 0; k < 500; ++k) {
    bench.states[0].X_WT.p += Vec3(2e-6, 0.0, 2e-6);
    bench.step(0.02, 0.3);
  }
  for (int k = 0; k < 100; ++k) bench.step(0.3, 0.0);
  EXPECT_EQ(bench.said.back(), "object-released");
  EXPECT_EQ(bench.pellets[0].stuck, 1);
  EXPECT_NEAR(bench.pellets[0].p.z(), p.radius, 1e-12);
  EXPECT_NEAR(bench.pellets[0].p.x(), 1e-3, 0.2e-3);
}

TEST(Pellet, WhatSlippedOutIsNotTakenAgainBeforeTheJawsOpened) {
  const PelletParameters p;
  Bench bench(p);
  bench.step(0.02, 0.01);
  bench.states[0].X_WT.p.z() += 0.2e-3;
  for (int k = 0; k < 20; ++k) bench.step(0.02, 0.01);
  EXPECT_EQ(bench.said, (std::vector<std::string>{"object-taken", "object-slipped"}));
  bench.step(0.3, 0.0);
  bench.step(0.02, 0.2);
  EXPECT_EQ(bench.said.back(), "object-taken");
}

}  // namespace pellet_test
}  // namespace filum
