#include "world/pull_test.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "physics/step_control.h"

namespace filum {
namespace {

constexpr double kShortest = 2.5e-4;  // [s], step
constexpr int kIterations = 12;
constexpr double kGivenWay = 0.3;  // a pull below this share of the largest, over this share of the opening allowed: the knot has given way
constexpr double kImbalance = 3e-6;  // [N], of a node, that is small against the pulls measured
constexpr double kMean = 0.02;      // [s], over which the pull is averaged: sticking and slipping on the bars is not the knot's doing

/// The two bars in the loop and the thread on them.
struct Rig {
  Rig(const Model& model, const State& state);

  /// One step in which each bar moves at `speed` [m/s].
  void step(double speed);

  const Model& model;
  RodState thread;
  ImplicitRod rod;
  RodMemory memory;
  RodStepOptions options;
  std::array<Vec3, 2> place;  // [m], of the bars
  Vec3 apart;           // unit, direction in which the second bar moves
  StepControl control;
  double travel = 0.0;  // [m], of each bar so far
  double pull = 0.0;    // [N], mean over kMean
  double residual = 0.0;
  bool parted = false;
};

/// Middle of the thread's contacts with itself: where the knot is.
Vec3 middle_of_contacts(const RodState& s, const std::vector<ContactBristle>& touching, const Vec3& otherwise) {
  Vec3 sum = Vec3::Zero();
  for (const ContactBristle& b : touching) sum += 0.5 * (s.x.col(b.i) + s.x.col(b.i + 1));
  return touching.empty() ? otherwise : Vec3(sum / static_cast<double>(touching.size()));
}

/// Across the post and across the way from its axis to the knot, so that the knot lies between the bars.
Vec3 bar_direction(const PostShape& post, const Vec3& knot) {
  Vec3 out = knot - post.p_W;
  out -= out.dot(post.axis_W) * post.axis_W;
  if (out.norm() < 1e-9) out = post.axis_W.unitOrthogonal();
  return post.axis_W.cross(out).normalized();
}

Rig::Rig(const Model& m, const State& state)
    : model(m),
      thread(state.thread),
      rod(m.thread, m.contact, m.description.capacity),
      memory(rod.make_memory()),
      options(m.step),
      control(kShortest, m.step.dt) {
  const PostShape& post = m.description.post;
  memory.self = state.memory.self;
  thread.v.setZero();
  thread.theta_dot.setZero();
  options.gravity.setZero();
  options.max_iterations = kIterations;
  options.force_tolerance = kImbalance;
  apart = bar_direction(post, middle_of_contacts(thread, memory.self, post.p_W + Vec3::UnitZ()));
  for (int side : {-1, 1}) {
    ObstacleBody body;
    place[rod.obstacles.bodies.size()] = post.p_W + 0.5 * side * post.radius * apart;
    Obstacle bar;
    bar.body = static_cast<int>(rod.obstacles.bodies.size());
    bar.a_B = -post.half_length * post.axis_W;
    bar.b_B = post.half_length * post.axis_W;
    bar.r_a = bar.r_b = 0.45 * post.radius;
    bar.friction = m.post_friction;
    rod.obstacles.bodies.push_back(body);
    rod.obstacles.obstacles.push_back(bar);
  }
}

void Rig::step(double speed) {
  const double dt = control.step(rod, thread, memory, options, [&](double length) {
    for (std::size_t k = 0; k < 2; ++k) {
      ObstacleBody& body = rod.obstacles.bodies[k];
      body.X_start.p = place[k];
      body.X_end.p = place[k] + (k == 0 ? -speed : speed) * length * apart;
    }
  });
  for (std::size_t k = 0; k < 2; ++k) place[k] = rod.obstacles.bodies[k].X_end.p;
  travel += speed * dt;
  residual = std::max(residual, control.summary().residual);
  for (int j = 0; j + 1 < thread.n; ++j)
    if (thread.alive[j] != 0 && edge_tension(model.thread, thread, j) > model.thread.strength) {
      thread.alive[j] = 0;
      parted = true;
    }
  adapt_resolution(model.resolution, model.description.capacity, model.thread.radius, rod.contact(), rod.obstacles, thread, memory);
  const double now = 0.5 * (rod.obstacles.bodies[0].force - rod.obstacles.bodies[1].force).dot(apart);
  pull += (now - pull) * dt / (dt + kMean);
}

}  // namespace

PullTestReport pull_test(const Model& model, const State& state, const PullTestOptions& o) {
  Rig rig(model, state);
  PullTestReport report;
  report.most_pull = o.most_pull;
  double taut_at = -1.0;  // [m], travel at which the loop became taut
  double done = 0.0;       // of the way to any of the ends of the test
  double strong_at = 0.0;  // [m], travel at which the pull was last near its largest
  while (rig.travel < o.most_travel && !rig.parted) {
    rig.step(taut_at < 0.0 ? o.fast : o.slow);
    ++report.steps;
    report.force = std::max(report.force, rig.pull);
    if (taut_at < 0.0 && rig.pull >= o.taut_pull) taut_at = rig.travel;
    report.opening = taut_at < 0.0 ? 0.0 : 2.0 * (rig.travel - taut_at);
    report.held = rig.pull >= o.most_pull;
    done = std::max({done, rig.pull / o.most_pull, report.opening / o.allowed, rig.travel / o.most_travel});
    if (o.go_on && !o.go_on(std::min(done, 1.0))) report.abandoned = true;
    if (report.abandoned) break;
    if (report.held || report.opening >= o.allowed) break;
    if (rig.pull > kGivenWay * report.force) strong_at = rig.travel;
    if (taut_at >= 0.0 && 2.0 * (rig.travel - strong_at) > kGivenWay * o.allowed) break;
  }
  if (report.held) report.force = o.most_pull;
  report.parted = rig.parted;
  report.residual = rig.residual;
  return report;
}

}  // namespace filum
