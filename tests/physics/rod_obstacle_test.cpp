#include "physics/rod_obstacle.h"

#include <gtest/gtest.h>

#include <cmath>

#include "physics/implicit_rod.h"

namespace filum {
namespace rod_obstacle_test {

constexpr double kFriction = 0.3, kGravity = 9.81;

RodMaterial nylon() {
  RodMaterial m;
  m.internal_friction = 0.01;
  return m;
}

/// A straight 10 mm thread `height` above a horizontal sheet.
struct Sheet {
  RodMaterial m = nylon();
  ContactMaterial c;
  ImplicitRod rod{m, c, 21};
  RodState s;
  RodMemory memory = rod.make_memory();
  RodStepOptions o;

  explicit Sheet(double height) {
    Points x = Points::Zero(3, 21);
    for (int i = 0; i < 21; ++i) x.col(i) = Vec3(0.5e-3 * i, 0, height + m.radius);
    s = RodState::from_nodes(x, 21);
    rod.obstacles.bodies.emplace_back();
    Obstacle plane;
    plane.kind = Obstacle::Kind::plane;
    plane.friction = kFriction;
    rod.obstacles.obstacles.push_back(plane);
  }
  double weight() const { return m.mass_per_length() * 10e-3 * kGravity; }
  void load_along_x(double total) {
    rod.boundary.load.row(0).leftCols(21).setConstant(total / 20.0);
    rod.boundary.load(0, 0) = rod.boundary.load(0, 20) = total / 40.0;
  }
  bool run(int steps) {
    bool converged = true;
    for (int k = 0; k < steps; ++k) converged = rod.step(s, memory, o).converged && converged;
    return converged;
  }
};

TEST(RodObstacle, ThreadDroppedOnTheSheetRestsWithItsWeight) {
  Sheet sheet(0.2e-3);
  sheet.run(500);
  EXPECT_NEAR(sheet.rod.obstacles.bodies[0].force.z(), -sheet.weight(), 1e-3 * sheet.weight());
  EXPECT_NEAR(sheet.rod.obstacles.bodies[0].force.head<2>().norm(), 0.0, 1e-3 * sheet.weight());
  EXPECT_LT(sheet.s.v.cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_NEAR(sheet.s.x.row(2).minCoeff(), sheet.m.radius, 1e-9);
  EXPECT_NEAR(sheet.s.x.row(2).maxCoeff(), sheet.m.radius, 1e-9);
}

TEST(RodObstacle, AnEndInsideANeedleIsNotBorneByTheSheet) {
  for (const bool bears_end : {true, false}) {
    Sheet sheet(0.0);
    sheet.rod.obstacles.obstacles[0].bears_end = bears_end;
    sheet.run(200);
    sheet.rod.boundary.load(2, 20) = -1e-3;
    sheet.run(500);
    const double deep = sheet.m.radius - sheet.s.x(2, 20);
    if (bears_end) EXPECT_LT(deep, 0.3 * sheet.m.radius);  // 1 mN squeezes the thread by less
    else EXPECT_GT(deep, sheet.m.radius);
  }
}

TEST(RodObstacle, StaysUnderALoadBelowTheLimitOfFriction) {
  Sheet sheet(0.0);
  sheet.run(200);
  sheet.load_along_x(0.95 * kFriction * sheet.weight());
  sheet.run(500);
  const Points soon = sheet.s.x;
  sheet.run(2000);
  EXPECT_LT((sheet.s.x - soon).cwiseAbs().maxCoeff(), 1e-11);  // 2 s
}

TEST(RodObstacle, AcceleratesUnderALoadAboveTheLimitOfFriction) {
  Sheet sheet(0.0);
  sheet.rod.material.drag = 0.0;
  sheet.run(200);
  sheet.load_along_x(1.5 * kFriction * sheet.weight());
  sheet.run(20);
  const double before = sheet.s.v.row(0).mean();
  sheet.run(50);
  const double acceleration = (sheet.s.v.row(0).mean() - before) / (50 * sheet.o.dt);
  EXPECT_NEAR(acceleration, 0.5 * kFriction * kGravity, 0.01 * kGravity);
}

/// A straight 10 mm thread without weight, along x, and a bar that is led.
struct BarAtThread {
  RodMaterial m = nylon();
  ImplicitRod rod{m, ContactMaterial(), 21};
  RodState s;
  RodMemory memory = rod.make_memory();
  RodStepOptions o;

  BarAtThread(const Vec3& a_B, const Vec3& b_B, double radius) {
    Points x = Points::Zero(3, 21);
    for (int i = 0; i < 21; ++i) x.col(i) = Vec3(0.5e-3 * i, 0, 0);
    s = RodState::from_nodes(x, 21);
    rod.obstacles.bodies.emplace_back();
    Obstacle bar;
    bar.a_B = a_B;
    bar.b_B = b_B;
    bar.r_a = bar.r_b = radius;
    rod.obstacles.obstacles.push_back(bar);
    o.gravity.setZero();
  }
  ObstacleBody& body() { return rod.obstacles.bodies[0]; }
};

TEST(RodObstacle, BarDrivenFastIntoTheThreadTakesItAlong) {
  BarAtThread scene(Vec3(5e-3, 0, -3e-3), Vec3(5e-3, 0, 3e-3), 0.1e-3);
  ObstacleBody& body = scene.body();
  body.X_start.p = body.X_end.p = Vec3(0, -0.5e-3, 0);
  for (int k = 0; k < 50; ++k) {  // 1 m/s: five bar diameters a step
    body.X_start = body.X_end;
    body.X_end.p.y() += 1e-3;
    scene.rod.step(scene.s, scene.memory, scene.o);
    const double bar_y = body.X_now.p.y();
    ASSERT_GT(scene.s.x(1, 10), bar_y) << "the bar passed through, step " << k;
  }
  EXPECT_GT(scene.s.x(1, 10), 40e-3);
}

TEST(RodObstacle, BarTurnedAboutItsEndTakesTheThreadAlong) {  // a shaft behind a tip that stays
  constexpr double kRadius = 1e-3;
  BarAtThread scene(Vec3::Zero(), Vec3(0, 0, 60e-3), kRadius);
  scene.o.longest_move = 16.0 * scene.m.radius;
  ObstacleBody& body = scene.body();
  const Vec3 tip(5e-3, -4e-3, -50e-3);
  const auto turned = [&](double angle) { return Pose{tip, Quat(Eigen::AngleAxisd(-angle, Vec3::UnitX()))}; };
  body.X_end = turned(0.0);
  for (int k = 0; k < 6; ++k) {  // 4 to 6 mm a step where it meets the thread, from 3 mm beside it
    body.X_start = body.X_end;
    body.X_end = turned(0.1 * (k + 1));
    scene.rod.step(scene.s, scene.memory, scene.o);
    const Vec3 axis = body.X_now.q * Vec3::UnitZ(), out = axis.cross(Vec3::UnitX());
    ASSERT_GT(out.dot(scene.s.x.col(10) - tip), 0.5 * kRadius) << "the bar passed through, step " << k;
  }
  EXPECT_GT(scene.s.x(1, 10), 15e-3);
}

TEST(RodObstacle, StretchHeldInTheJawsAndPartedEdgesAreNotTouched) {
  RodObstacles o(50);
  o.bodies.emplace_back();
  Obstacle bar;
  bar.a_B = Vec3(5e-3, -1e-3, 0);
  bar.b_B = Vec3(5e-3, 1e-3, 0);
  bar.r_a = bar.r_b = 0.1e-3;
  o.obstacles.push_back(bar);
  Points x = Points::Zero(3, 21);
  for (int i = 0; i < 21; ++i) x.col(i) = Vec3(0.5e-3 * i, 0, 0);
  RodState s = RodState::from_nodes(x, 21);
  const Eigen::VectorXd reach = Eigen::VectorXd::Constant(21, 10e-6);
  o.find_touches(s, x, 12.5e-6, reach);
  EXPECT_FALSE(o.touches().empty());
  s.alive[9] = s.alive[10] = 0;
  o.find_touches(s, x, 12.5e-6, reach);
  EXPECT_TRUE(o.touches().empty()) << "a parted edge is not there";
  s.alive.setOnes();
  o.obstacles[0].ignore_from = 4e-3;
  o.obstacles[0].ignore_to = 6e-3;
  o.find_touches(s, x, 12.5e-6, reach);
  EXPECT_TRUE(o.touches().empty());
}

TEST(RodObstacle, EveryPieceOfACutThreadLiesOnTheSheetWithBothItsEnds) {
  constexpr int kNodes = 12;
  Points x(3, kNodes);
  for (int i = 0; i < kNodes; ++i) x.col(i) = Vec3(0.4e-3 * i, 0, 0.1e-3);
  RodMaterial m;
  RodState s = RodState::from_nodes(x, kNodes);
  s.alive[4] = s.alive[5] = 0;  // two pieces and a single node between them
  ImplicitRod rod(m, ContactMaterial(), kNodes);
  rod.obstacles.bodies.emplace_back();
  Obstacle sheet;
  sheet.kind = Obstacle::Kind::plane;
  rod.obstacles.obstacles.push_back(sheet);
  RodMemory memory = rod.make_memory();
  RodStepOptions o;
  o.dt = 2e-3;
  for (int k = 0; k < 200; ++k) rod.step(s, memory, o);
  for (int i = 0; i < kNodes; ++i) EXPECT_GT(s.x(2, i), 0.0) << "node " << i << " sank through the sheet";
  EXPECT_LT(s.x.row(2).maxCoeff(), 0.05e-3) << "or nothing fell";
}

}  // namespace rod_obstacle_test
}  // namespace filum
