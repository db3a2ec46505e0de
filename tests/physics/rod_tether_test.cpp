#include "physics/rod_tether.h"

#include <gtest/gtest.h>

#include <cmath>

#include "physics/implicit_rod.h"

namespace filum {
namespace rod_tether_test {

RodState straight(int n, double edge) {
  Points nodes(3, n);
  for (int i = 0; i < n; ++i) nodes.col(i) = Vec3(edge * i, 0, 0);
  return RodState::from_nodes(nodes, n + 4);
}

RodTether ring(double arc, double limit) {
  RodTether t;
  t.arc = arc;
  t.along = Vec3::UnitX();
  t.stiffness = 300.0 * (Mat3::Identity() - t.along * t.along.transpose());
  t.stick = 300.0;
  t.limit = limit;
  t.drag = 0.05;
  return t;
}

TEST(RodTether, ForceIsMinusTheSlopeOfItsEnergy) {
  RodState s = straight(5, 1e-3);
  RodTethers tethers(4);
  for (const double limit : {1e-3, 1e-5}) {  // sticks, slips
    tethers.list = {ring(1.3e-3, limit)};
    tethers.list[0].anchor = Vec3(1.29e-3, 20e-6, -10e-6);
    tethers.locate(s);
    Eigen::Matrix4Xd gradient = Eigen::Matrix4Xd::Zero(4, 9);
    tethers.add_gradient(s.x, 2e-3, gradient);
    for (int i = 0; i < 5; ++i) {
      for (int c = 0; c < 3; ++c) {
        constexpr double kStep = 1e-9;
        Points up = s.x, down = s.x;
        up(c, i) += kStep;
        down(c, i) -= kStep;
        const double slope = (tethers.energy(up, 2e-3) - tethers.energy(down, 2e-3)) / (2.0 * kStep);
        EXPECT_NEAR(gradient(c, i), slope, 1e-7) << i << c;
      }
    }
  }
}

/// Friction in the plane of a surface: energy and force agree, stuck and slipping any way.
TEST(RodTether, FrictionInAPlaneIsTheSlopeOfItsEnergy) {
  RodState s = straight(5, 1e-3);
  RodTethers tethers(4);
  for (const double limit : {1e-2, 1e-3}) {  // sticks, slips
    RodTether t = ring(1.3e-3, limit);
    t.drag = 0.0;
    t.stiffness = 200.0 * Vec3::UnitZ() * Vec3::UnitZ().transpose();
    t.across = Vec3::UnitY();
    t.anchor = Vec3(1.29e-3, 20e-6, -10e-6);
    tethers.list = {t};
    tethers.locate(s);
    Eigen::Matrix4Xd gradient = Eigen::Matrix4Xd::Zero(4, 9);
    tethers.add_gradient(s.x, 2e-3, gradient);
    const RodTether& held = tethers.list[0];
    EXPECT_NEAR(std::hypot(held.force.x(), held.force.y()), limit > 5e-3 ? 300.0 * std::hypot(10e-6, 20e-6) : limit, 1e-12);
    EXPECT_NEAR(held.force.y() / held.force.x(), -2.0, 1e-9) << "against the slip";
    for (int i = 1; i < 3; ++i)
      for (int c = 0; c < 3; ++c) {
        constexpr double kStep = 1e-9;
        Points up = s.x, down = s.x;
        up(c, i) += kStep;
        down(c, i) -= kStep;
        const double slope = (tethers.energy(up, 2e-3) - tethers.energy(down, 2e-3)) / (2.0 * kStep);
        EXPECT_NEAR(gradient(c, i), slope, 1e-7) << i << c;
      }
  }
}

/// A thread drawn through a ring by `speed` [m/s]; force of the ring along it.
double drawn_through(double limit, double drag, double speed) {
  RodState s = straight(12, 1e-3);
  ImplicitRod rod(RodMaterial(), ContactMaterial(), 16);
  RodMemory memory = rod.make_memory();
  RodStepOptions o;
  o.dt = 2e-3;
  o.gravity.setZero();
  double arc = 5e-3, force = 0.0;
  for (int k = 0; k < 200; ++k) {
    for (int c = 0; c < 3; ++c) rod.boundary.held(c, 11) = true;
    rod.boundary.target.col(11).head<3>() = s.x.col(11) + Vec3(speed * o.dt, 0, 0);
    RodTether t = ring(arc, limit);
    t.drag = drag;
    t.anchor = Vec3(5e-3, 0, 0);
    const int edge = static_cast<int>(arc / 1e-3);
    t.start = (1.0 - (arc / 1e-3 - edge)) * s.x(0, edge) + (arc / 1e-3 - edge) * s.x(0, edge + 1) - 5e-3;
    rod.tethers.list = {t};
    rod.step(s, memory, o);
    arc -= rod.tethers.list[0].slid;
    force = -rod.tethers.list[0].force.x();
  }
  return force;
}

TEST(RodTether, ThreadThroughARingFeelsDryFrictionAndSpeed) {
  EXPECT_NEAR(drawn_through(2e-3, 0.0, 5e-3), 2e-3, 2e-5);
  EXPECT_NEAR(drawn_through(1e-3, 0.1, 5e-3), 1e-3 + 0.1 * 5e-3, 3e-5);
}

TEST(RodTether, EndGivesAsMuchAsWhatHoldsIt) {
  // Thread (k = EA/L) in series with the tether: one force in both.
  RodState s = straight(12, 1e-3);
  const RodMaterial m;
  ImplicitRod rod(m, ContactMaterial(), 16);
  RodMemory memory = rod.make_memory();
  RodStepOptions o;
  o.gravity.setZero();
  for (int c = 0; c < 3; ++c) rod.boundary.held(c, 0) = true;
  rod.boundary.target.col(0).head<3>() = s.x.col(0);
  RodTether t;
  t.at_end = true;
  t.stiffness = 50.0 * Mat3::Identity();
  t.anchor = Vec3(11e-3 + 100e-6, 0, 0);
  rod.tethers.list = {t};
  for (int k = 0; k < 400; ++k) rod.step(s, memory, o);
  const double thread = m.EA / 11e-3, series = 1.0 / (1.0 / thread + 1.0 / 50.0);
  EXPECT_NEAR(rod.tethers.list[0].force.x(), series * 100e-6, 1e-3 * series * 100e-6);
}

/// A surface has gone on under a thread that friction can hold: a step finds where the thread sticks again.
TEST(RodTether, WhatSlippedToAndFroSticks) {
  int most = 0;
  for (int k = 0; k < 40; ++k) {
    RodState s = straight(12, 0.2e-3);
    ImplicitRod rod(RodMaterial(), ContactMaterial(), 16);
    RodMemory memory = rod.make_memory();
    RodStepOptions o;
    o.dt = 2e-3;
    o.gravity.setZero();
    for (int i = 0; i < 12; ++i) {
      RodTether t;
      t.arc = 0.2e-3 * i;
      t.along = Vec3::UnitX();
      t.across = Vec3::UnitY();
      t.stiffness = 200.0 * Vec3::UnitZ() * Vec3::UnitZ().transpose();
      t.stick = 400.0;
      t.limit = 20e-6;
      t.anchor = s.x.col(i) + 1e-6 * (1 + k) * Vec3(1e-3 * std::sin(3.0 * i + k), 1.0 + 3e-3 * std::cos(2.0 * i + k), -1.0 / (1 + k));
      rod.tethers.list.push_back(t);
    }
    const RodStepSummary r = rod.step(s, memory, o);
    EXPECT_TRUE(r.converged) << k;
    most = std::max(most, r.iterations);
  }
  EXPECT_LE(most, 8) << "by Newton's matrix alone 20, and not there";
}

}  // namespace rod_tether_test
}  // namespace filum
