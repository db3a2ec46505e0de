#include "physics/step_control.h"

#include <gtest/gtest.h>

#include <vector>

namespace filum {
namespace step_control_test {

constexpr int kNodes = 31;
constexpr double kShortest = 1e-5, kLongest = 1e-2;

/// A horizontal thread clamped at one end, with the load of ten times its bending scale hung on the other end at once.
struct LoadedThread {
  LoadedThread() : rod(material(), ContactMaterial(), kNodes), memory(rod.make_memory()) {
    Points nodes = Points::Zero(3, kNodes);
    for (int i = 0; i < kNodes; ++i) nodes(0, i) = 2e-4 * i;
    s = RodState::from_nodes(nodes, kNodes);
    for (int i : {0, 1}) {
      rod.boundary.held.col(i) = true;
      rod.boundary.target.col(i).head<3>() = s.x.col(i);
    }
    const double length = 2e-4 * (kNodes - 1);
    rod.boundary.load(2, kNodes - 1) = -10.0 * rod.material.EI / (length * length);
    options.relative_tolerance = 1e-6;
  }
  static RodMaterial material() {
    RodMaterial m;
    m.internal_friction = 0.01;
    return m;
  }
  ImplicitRod rod;
  RodState s;
  RodMemory memory;
  RodStepOptions options;
};

TEST(StepControl, StepThatDoesNotConvergeIsTakenBackAndShortened) {
  LoadedThread t;
  t.options.max_iterations = 4;
  RodState first = t.s;
  ASSERT_FALSE(t.rod.step(first, t.memory, [&] { RodStepOptions o = t.options; o.dt = kLongest; return o; }()).converged)
      << "the case must be hard enough to say anything";
  StepControl control(kShortest, kLongest);
  double time = 0.0;
  std::vector<double> asked;
  while (time < 0.3) {
    asked.clear();
    const Points before = t.s.x;
    const double dt = control.step(t.rod, t.s, t.memory, t.options, [&](double length) { asked.push_back(length); });
    ASSERT_FALSE(asked.empty());
    EXPECT_EQ(asked.back(), dt) << "the paths were set for the step that was taken";
    for (std::size_t k = 1; k < asked.size(); ++k) EXPECT_LT(asked[k], asked[k - 1]);
    EXPECT_TRUE(control.summary().converged || dt == kShortest);
    // the velocity is that of the accepted step alone
    EXPECT_LT((t.s.v.leftCols(kNodes) * dt - (t.s.x - before).leftCols(kNodes)).cwiseAbs().maxCoeff(), 1e-15);
    time += dt;
  }
  EXPECT_GT(control.repeats(), 0);
  // Where it comes to rest is where long steps with all the iterations they want come to rest.
  LoadedThread plain;
  plain.options.max_iterations = 200;
  plain.options.dt = kLongest;
  for (int k = 0; k < 60; ++k) plain.rod.step(plain.s, plain.memory, plain.options);
  for (int k = 0; k < 30; ++k) t.rod.step(t.s, t.memory, plain.options);
  EXPECT_LT((t.s.x - plain.s.x).cwiseAbs().maxCoeff(), 2e-7);
}

TEST(StepControl, EasyStepsKeepTheirLength) {
  LoadedThread t;
  t.rod.boundary.load.setZero();
  StepControl control(kShortest, kLongest);
  for (int k = 0; k < 5; ++k) EXPECT_EQ(control.step(t.rod, t.s, t.memory, t.options, [](double) {}), kLongest);
  EXPECT_EQ(control.repeats(), 0);
}

}  // namespace step_control_test
}  // namespace filum
