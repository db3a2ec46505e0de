#include "physics/instrument.h"

#include <gtest/gtest.h>

namespace filum {
namespace instrument_test {

constexpr double kStep = 2e-3;

struct Tool {
  InstrumentParameters p;
  Instruments instruments{{p}};
  std::vector<InstrumentState> states{1};
  std::vector<InstrumentCommand> commands{1};
  std::vector<Vec3> force{Vec3::Zero()}, torque{Vec3::Zero()};

  InstrumentState& state() { return states[0]; }
  InstrumentCommand& command() { return commands[0]; }
  void run(double seconds) {
    for (int k = 0; k < static_cast<int>(seconds / kStep); ++k) instruments.step(states, commands, force, torque, kStep);
  }
};

TEST(Instrument, ReachesTheDevicePose) {
  Tool t;
  t.command().X_WD = {Vec3(5e-3, -3e-3, 8e-3), Quat(Eigen::AngleAxisd(0.8, Vec3(1, 2, -1).normalized()))};
  t.run(1.0);
  EXPECT_NEAR((t.state().X_WT.p - t.command().X_WD.p).norm(), 0.0, 1e-7);
  EXPECT_NEAR(t.state().X_WT.q.angularDistance(t.command().X_WD.q), 0.0, 1e-4);
  EXPECT_NEAR(t.state().v.norm(), 0.0, 1e-6);
}

TEST(Instrument, FollowsASteadyMotionWithoutFallingBehind) {
  Tool t;
  for (int k = 0; k < 500; ++k) {
    t.command().X_WD.p.x() += 0.05 * kStep;
    t.instruments.step(t.states, t.commands, t.force, t.torque, kStep);
  }
  EXPECT_NEAR(t.state().v.x(), 0.05, 5e-4);
  EXPECT_LT(std::abs(t.state().X_WT.p.x() - t.command().X_WD.p.x()), 0.05 * kStep);
}

TEST(Instrument, SteadyOffsetIsForceOverStiffness) {
  Tool t;
  t.force[0] = Vec3(0.1, 0, -0.05);
  t.run(1.0);
  EXPECT_NEAR((t.state().X_WT.p - t.force[0] / t.p.coupling_stiffness).norm(), 0.0, 1e-7);
  t.force[0].setZero();
  t.torque[0] = Vec3(0, 0, 2e-3);
  t.run(1.0);
  EXPECT_NEAR(t.state().X_WT.q.angularDistance(Quat::Identity()), 2e-3 / t.p.turning_stiffness, 1e-4);
}

TEST(Instrument, ClosesAndOpensItsJaws) {
  Tool t;
  t.command().grip_angle = -0.05;
  t.run(0.3);
  EXPECT_NEAR(t.state().angle, 0.0, 1e-3);
  t.command().grip_angle = 0.25;
  t.run(0.3);
  EXPECT_NEAR(t.state().angle, 0.25, 1e-3);
  t.command().grip_angle = 2.0;
  t.run(0.3);
  EXPECT_NEAR(t.state().angle, t.p.max_angle, 1e-3);
}

TEST(Instrument, GripForceComesFromTheSqueezeBeyondClosure) {
  Tool t;
  t.command().grip_angle = 0.2;
  t.run(0.3);
  EXPECT_EQ(t.state().grip_force, 0.0);
  t.command().grip_angle = -0.1;
  t.run(0.3);
  EXPECT_NEAR(t.state().grip_force, t.p.grip_stiffness * 0.1 / t.p.jaw_length, 0.02);
  t.command().grip_angle = -50.0;
  t.run(0.1);
  EXPECT_EQ(t.state().grip_force, t.p.max_grip_force);
}

TEST(Instrument, MeasuredGripForceGoesBeforeTheSqueeze) {
  Tool t;
  t.command().grip_angle = -0.1;
  t.command().has_grip_force = true;
  t.command().grip_force = 0.7;
  t.run(0.3);
  EXPECT_EQ(t.state().grip_force, 0.7);
  t.command().grip_force = -1.0;
  t.run(0.01);
  EXPECT_EQ(t.state().grip_force, 0.0);
  t.command().grip_force = 1e6;
  t.run(0.01);
  EXPECT_EQ(t.state().grip_force, t.p.max_grip_force);
}

TEST(Instrument, WithoutADeviceKeepsTheLastPose) {
  Tool t;
  t.command().X_WD.p = Vec3(1e-3, 0, 0);
  t.command().grip_angle = 0.1;
  t.run(0.5);
  t.command() = InstrumentCommand{};
  t.command().X_WD.p = Vec3(9, 9, 9);
  t.command().follow = false;
  t.run(0.5);
  EXPECT_NEAR((t.state().X_WT.p - Vec3(1e-3, 0, 0)).norm(), 0.0, 1e-7);
  EXPECT_NEAR(t.state().angle, 0.1, 1e-3);
}

TEST(Instrument, JumpingDeviceAndHeavyLoadStayBounded) {
  Tool t;
  for (int k = 0; k < 400; ++k) {
    t.command().X_WD.p = Vec3(k % 2 == 0 ? 0.5 : -0.5, 0, 0);
    t.command().X_WD.q = Quat(Eigen::AngleAxisd(k % 3 * 2.0, Vec3::UnitX()));
    t.force[0] = Vec3(0, k % 5 == 0 ? 5.0 : -5.0, 0);
    t.instruments.step(t.states, t.commands, t.force, t.torque, kStep);
    ASSERT_TRUE(t.state().X_WT.finite());
    ASSERT_LT(t.state().X_WT.p.norm(), 1.0);
  }
  t.force[0].setZero();
  t.command() = InstrumentCommand{};
  t.run(1.0);
  EXPECT_NEAR(t.state().X_WT.p.norm(), 0.0, 1e-6);
}

TEST(Instrument, JawsMeetWhenClosedAndPartWhenOpened) {
  const InstrumentParameters p;
  const double clearance = 25e-6;
  const InstrumentBars closed = instrument_bars(p, 0.0, clearance), open = instrument_bars(p, 0.3, clearance);
  EXPECT_NEAR(closed.a_T[0].x() - closed.a_T[1].x() - closed.r_a[0] - closed.r_a[1], clearance, 1e-12);
  EXPECT_NEAR(closed.a_T[0].z(), 0.0, 1e-12);
  EXPECT_NEAR(open.a_T[0].x() - open.a_T[1].x() - open.r_a[0] - open.r_a[1], clearance + 2.0 * p.jaw_length * std::sin(0.15), 1e-5);
  EXPECT_GT(open.b_T[2].z(), open.a_T[2].z());
}

}  // namespace instrument_test
}  // namespace filum
