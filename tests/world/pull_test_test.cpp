#include "world/pull_test.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "physics/step_control.h"
#include "tests/training/knot_shapes.h"
#include "world/world.h"

namespace filum {
namespace pull_test_test {

/// Points evenly spaced along the polyline, its corners rounded.
Points even_and_smooth(const Points& p, double spacing) {
  std::vector<double> arc{0.0};
  for (Eigen::Index i = 1; i < p.cols(); ++i) arc.push_back(arc.back() + (p.col(i) - p.col(i - 1)).norm());
  const int n = static_cast<int>(arc.back() / spacing);
  Points r(3, n + 1);
  for (int i = 0, k = 0; i <= n; ++i) {
    const double s = arc.back() * i / n;
    while (k + 2 < p.cols() && arc[static_cast<std::size_t>(k) + 1] < s) ++k;
    const double a = arc[static_cast<std::size_t>(k)], b = arc[static_cast<std::size_t>(k) + 1];
    r.col(i) = p.col(k) + (p.col(k + 1) - p.col(k)) * ((s - a) / (b - a));
  }
  for (int pass = 0; pass < 4; ++pass) {
    const Points old = r;
    for (int i = 1; i < n; ++i) r.col(i) = 0.25 * old.col(i - 1) + 0.5 * old.col(i) + 0.25 * old.col(i + 1);
  }
  return r;
}

struct Scene {
  Model model;
  State state;
};

/// Throws of `half_twists` laid round a bar of the task's scene, with nothing pulled yet.
Scene laid(const std::vector<int>& half_twists) {
  Scene scene{*load_model(FILUM_SOURCE_DIR, "knot-square"), {}};
  const Points path = even_and_smooth(shapes::throws_round_post(half_twists, 80e-6, 4), 40e-6);
  scene.model.description.post = shapes::post();
  scene.model.description.capacity = 300;
  scene.state.thread = RodState::from_nodes(path, 300);
  return scene;
}

/// The same, drawn tight by its ends, apart along the throws, until they pull with `tension` [N].
Scene tied(const std::vector<int>& half_twists, double tension) {
  Scene scene = laid(half_twists);
  const Model& m = scene.model;
  RodState& s = scene.state.thread;
  ImplicitRod rod(m.thread, m.contact, m.description.capacity);
  scene.state.memory = rod.make_memory();
  Obstacle bar;
  bar.a_B = m.description.post.p_W - m.description.post.half_length * m.description.post.axis_W;
  bar.b_B = m.description.post.p_W + m.description.post.half_length * m.description.post.axis_W;
  bar.r_a = bar.r_b = m.description.post.radius;
  bar.friction = m.post_friction;
  rod.obstacles.bodies.emplace_back();
  rod.obstacles.obstacles.push_back(bar);
  RodStepOptions options = m.step;
  options.gravity.setZero();
  options.max_iterations = 12;
  options.force_tolerance = 3e-6;
  StepControl control(2e-4, m.step.dt);
  Vec3 low = s.x.col(0), high = s.x.col(s.n - 1);
  const Vec3 apart = Vec3((high - low).x(), 0, 0).normalized();
  for (double time = 0.0; time < 0.5 && edge_tension(m.thread, s, 1) < tension;) {
    const double speed = time < 0.05 ? 0.0 : 10e-3;
    const double dt = control.step(rod, s, scene.state.memory, options, [&](double length) {
      rod.boundary.held.setConstant(false);
      for (int i : {0, s.n - 1}) rod.boundary.held.col(i).head<3>() = true;
      rod.boundary.target.col(0).head<3>() = low - speed * length * apart;
      rod.boundary.target.col(s.n - 1).head<3>() = high + speed * length * apart;
    });
    low -= speed * dt * apart;
    high += speed * dt * apart;
    time += dt;
    adapt_resolution(m.resolution, m.description.capacity, m.thread.radius, rod.contact(), rod.obstacles, s, scene.state.memory);
  }
  return scene;
}

PullTestOptions one_millinewton() {
  PullTestOptions o;
  o.most_pull = 1e-3;
  o.taut_pull = 0.2e-3;
  o.allowed = 1e-3;
  return o;
}

TEST(PullTest, TellsHowFarItIsAndCanBeAbandoned) {
  const Scene scene = laid({1, -1});
  std::vector<double> told;
  PullTestOptions o;
  o.go_on = [&](double done) {
    told.push_back(done);
    return told.size() < 20;
  };
  const PullTestReport r = pull_test(scene.model, scene.state, o);
  EXPECT_TRUE(r.abandoned);
  EXPECT_EQ(r.steps, 20);
  ASSERT_EQ(told.size(), 20u);
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
  EXPECT_GT(told.back(), 0.0);
  EXPECT_LE(told.back(), 1.0);
}

TEST(PullTest, TightSquareKnotHolds) {
  const Scene scene = tied({3, -3}, 15e-3);
  ASSERT_GT(edge_tension(scene.model.thread, scene.state.thread, 1), 15e-3) << "it was drawn tight";
  EXPECT_LE(scene.state.thread.n, 200) << "a tight two-throw knot is resolved within 200 nodes";
  const PullTestReport r = pull_test(scene.model, scene.state, one_millinewton());
  EXPECT_TRUE(r.held) << r.force << " N after opening " << r.opening << " m";
  EXPECT_EQ(r.force, 1e-3);
  EXPECT_FALSE(r.parted);
}

TEST(PullTest, SingleThrowSlips) {
  const Scene scene = tied({3}, 15e-3);
  ASSERT_GT(edge_tension(scene.model.thread, scene.state.thread, 1), 15e-3) << "it was drawn tight";
  PullTestOptions o = one_millinewton();
  o.allowed = 0.5e-3;  // twice what the square knot opens under the same pull
  const PullTestReport r = pull_test(scene.model, scene.state, o);
  EXPECT_FALSE(r.held);
  EXPECT_LT(r.force, 1e-3);
  EXPECT_GT(r.force, 0.0);
}

TEST(PullTest, ThreadWithoutAKnotOffersNothing) {
  const Scene scene = laid({});
  const PullTestReport r = pull_test(scene.model, scene.state);
  EXPECT_FALSE(r.held);
  EXPECT_LT(r.force, 0.2e-3);
  EXPECT_EQ(r.most_pull, PullTestOptions().most_pull);
}

TEST(PullTest, SameStateGivesTheSameReportAndStaysAsItWas) {
  const Scene scene = laid({3});
  PullTestOptions o = one_millinewton();
  o.most_travel = 0.05e-3;
  const State before = scene.state;
  const PullTestReport a = pull_test(scene.model, scene.state, o), b = pull_test(scene.model, scene.state, o);
  EXPECT_EQ(a.force, b.force);
  EXPECT_EQ(a.opening, b.opening);
  EXPECT_EQ(a.steps, b.steps);
  EXPECT_EQ(scene.state.thread.x, before.thread.x);
  EXPECT_EQ(scene.state.thread.n, before.thread.n);
}

}  // namespace pull_test_test
}  // namespace filum
