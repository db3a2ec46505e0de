#include "physics/thread_grasp.h"

#include <gtest/gtest.h>

#include <cmath>

#include "physics/implicit_rod.h"

namespace filum {
namespace thread_grasp_test {

constexpr double kGrip = 0.1;  // [N]

/// A straight thread along y through the pads of one tool; its far end is led along y.
struct Held {
  RodMaterial m;
  RodState s;
  ImplicitRod rod{m, ContactMaterial(), 21, 1};
  RodMemory memory = rod.make_memory();
  RodStepOptions o;

  explicit Held(double grip) {
    Points x = Points::Zero(3, 21);
    for (int i = 0; i < 21; ++i) x.col(i) = Vec3(0, 0.5e-3 * (i - 3), 0.75e-3);
    s = RodState::from_nodes(x, 21);
    rod.grasps.tools[0].grip_force = grip;
    EXPECT_EQ(grasp_between(rod.grasps.tools[0].pads, Pose(), 0, s, 50e-6, memory.grasps), kGraspPointsPerTool);
    o.gravity.setZero();
  }
  double limit() const { return 2.0 * rod.grasps.tools[0].pads.friction * kGrip; }
  void pull(double force, int steps) {
    rod.boundary.load(1, 20) = force;
    for (int k = 0; k < steps; ++k) rod.step(s, memory, o);
  }
  void lead(double distance, int steps) {
    rod.boundary.held.col(20).head<3>().setConstant(true);
    Vec3 end = s.x.col(20);
    for (int k = 0; k < steps; ++k) {
      end.y() += distance / steps;
      rod.boundary.target.col(20).head<3>() = end;
      rod.step(s, memory, o);
    }
  }
};

TEST(ThreadGrasp, HoldsBelowTwiceMuN) {
  Held h(kGrip);
  h.pull(0.95 * h.limit(), 100);
  const double soon = h.s.x(1, 20);
  h.pull(0.95 * h.limit(), 1000);
  EXPECT_NEAR(h.s.x(1, 20), soon, 1e-9);
  ASSERT_EQ(h.memory.grasps.size(), 3u);
  EXPECT_NEAR(h.rod.grasps.tools[0].force.y(), 0.95 * h.limit(), 1e-3 * h.limit());
}

TEST(ThreadGrasp, SlidesAtTwiceMuNAndDropsAtThePadsEdge) {
  Held h(kGrip);
  h.lead(0.45e-3, 450);  // 4 % of strain, 0.34 mm, make 0.05 N: the rest must slide
  ASSERT_EQ(h.memory.grasps.size(), 2u) << "one point of three has gone over the edge";
  EXPECT_NEAR(h.rod.grasps.tools[0].force.y(), h.limit(), 0.01 * h.limit());
  h.lead(1e-3, 1000);
  EXPECT_TRUE(h.memory.grasps.empty());
  EXPECT_EQ(h.rod.grasps.held().size(), 0u);
  h.pull(0.0, 1);
  EXPECT_EQ(h.rod.grasps.tools[0].force.norm(), 0.0);
}

TEST(ThreadGrasp, WithoutGripNothingIsHeld) {
  Held h(0.0);
  h.o.gravity = Vec3(0, -9.81, 0);
  h.rod.material.drag = 0.0;
  h.pull(0.0, 3);
  EXPECT_NEAR(h.rod.grasps.tools[0].force.norm(), 0.0, 1e-9);
  h.pull(0.0, 60);
  EXPECT_TRUE(h.memory.grasps.empty());
  EXPECT_LT(h.s.v.row(1).maxCoeff(), -0.3);
}

TEST(ThreadGrasp, ForceOnTheToolHasItsMoment) {
  Held h(kGrip);
  h.pull(0.5 * h.limit(), 200);
  const Vec3 f = h.rod.grasps.tools[0].force;
  EXPECT_NEAR(h.rod.grasps.tools[0].torque.x(), -0.75e-3 * f.y(), 0.01 * 0.75e-3 * f.y());
}

TEST(ThreadGrasp, TakesOnlyWhatLiesBetweenThePads) {
  const Held h(kGrip);
  std::vector<GraspPoint> points;
  points.reserve(8);
  const Pads pads;
  EXPECT_EQ(grasp_between(pads, Pose{Vec3(1e-3, 0, 0), Quat::Identity()}, 0, h.s, 50e-6, points), 0);
  EXPECT_EQ(grasp_between(pads, Pose{Vec3(0, 0, 1e-3), Quat::Identity()}, 0, h.s, 50e-6, points), 0) << "tip is above the thread";
  EXPECT_EQ(grasp_between(pads, Pose{Vec3(0, 1e-3, 0), Quat::Identity()}, 2, h.s, 50e-6, points), kGraspPointsPerTool);
  for (const GraspPoint& p : points) {
    EXPECT_EQ(p.tool, 2);
    EXPECT_NEAR(p.arc, 1.5e-3 + 1e-3, pads.half_width);
    EXPECT_LT(std::abs(p.anchor_T.y()), pads.half_width);
  }
}

/// The gap between cut ends is no thread: held there, jaws drew the pieces together, and a needle off the thread that ends at it.
TEST(ThreadGrasp, AGapIsNotHeld) {
  Held h(kGrip);  // nodes 2, 3 and 4 at -0.5, 0 and 0.5 mm: the pads reach 0.15 mm to either side
  h.s.alive[3] = 0;
  std::vector<GraspPoint> points;
  EXPECT_EQ(grasp_between(h.rod.grasps.tools[0].pads, Pose(), 0, h.s, 50e-6, points), kGraspPointsPerTool);
  for (const GraspPoint& p : points) EXPECT_LE(p.anchor_T.y(), 1e-12);
  h.s.alive[2] = 0;
  points.clear();
  EXPECT_EQ(grasp_between(h.rod.grasps.tools[0].pads, Pose(), 0, h.s, 50e-6, points), 0) << "a gap on either side";
}

TEST(ThreadGrasp, MaterialCoordinateFindsItsEdge) {
  const Held h(kGrip);
  for (double arc : {0.0, 0.3e-3, 4.99e-3, 10e-3}) {
    const auto [edge, s] = locate_arc(h.s, arc);
    EXPECT_NEAR((edge + s) * 0.5e-3, arc, 1e-12);
  }
}

}  // namespace thread_grasp_test
}  // namespace filum
