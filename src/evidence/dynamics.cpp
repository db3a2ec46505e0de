// Motion without loss: the implicit midpoint rule on vibrating and on tumbling rods.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "evidence/problem_list.h"
#include "evidence/rod_probe.h"

namespace filum {
namespace {

constexpr double kPi = std::numbers::pi;

/// Shape of the first bending vibration of a cantilever of length 1 at s; tip 2.
double first_mode(double s) {
  constexpr double b = 1.875104069;
  const double ratio = (std::cosh(b) + std::cos(b)) / (std::sinh(b) + std::sin(b));
  return std::cosh(b * s) - std::cos(b * s) - ratio * (std::sinh(b * s) - std::sin(b * s));
}

/// Angular frequency [rad/s] from the times at which the tip of a small vibration passes the middle.
double cantilever_frequency(int edges) {
  const double edge = 1.0 / (edges - 0.5), dt = 0.05;
  const RodMaterial m = [] {
    RodMaterial wire = RodMaterial::round_wire(0.02, 1e5, 0.5, 500.0);
    wire.drag = 0.0;
    return wire;
  }();
  RodProbe probe(m, nodes_on_x(edges + 1, -0.5 * edge, edge));
  probe.hold(0);
  probe.hold(1);
  probe.options.dt = dt;
  for (int i = 2; i <= edges; ++i) probe.state.v(2, i) = 5e-4 * first_mode(probe.state.x(0, i));
  double first = 0.0, last = 0.0;
  int crossings = 0;
  for (int k = 1; crossings < 5 && k < 2000; ++k) {
    const double before = probe.state.x(2, edges);
    if (!probe.rod.midpoint_step(probe.state, probe.memory, probe.options).sound) break;
    const double after = probe.state.x(2, edges);
    if (k == 1 || before * after > 0.0) continue;
    last = dt * (k - after / (after - before));
    if (crossings++ == 0) first = last;
  }
  return kPi * (crossings - 1) / (last - first);
}

void list_frequency(ProblemList& list) {
  ValidationProblem p;
  p.name = "cantilever-frequency";
  p.source =
      "Euler-Bernoulli, omega = 3.51602 sqrt(B/(rho A))/L^2; rod of DisMech's cantilever: 1 m, radius 20 mm, "
      "0.1 MPa, 500 kg/m3";
  p.quantity = "first angular frequency";
  p.unit = "rad/s";
  p.expected = 3.51602 * std::sqrt(1e5 * std::pow(0.02, 2) / 4.0 / 500.0);
  p.tolerance = 1e-2;
  p.least_order = 1.8;
  list.push_back({p, [](ValidationProblem& r) {
                    r.got = cantilever_frequency(40);
                    r.order = observed_order(cantilever_frequency(10), cantilever_frequency(20), r.got);
                  }});
}

struct Momentum {
  Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();  // [kg m/s], [kg m2/s] about the origin
};

Momentum momentum_of(const RodMaterial& m, const RodState& s) {
  Momentum total;
  for (int j = 0; j + 1 < s.n; ++j) {
    const double mass = m.mass_per_length() * s.rest_length[j];
    for (int i = j; i <= j + 1; ++i) {
      total.linear += 0.5 * mass * s.v.col(i);
      total.angular += 0.5 * mass * s.x.col(i).cross(s.v.col(i));
    }
    const Vec3 tangent = (s.x.col(j + 1) - s.x.col(j)).normalized();
    total.angular += 0.5 * mass * m.radius * m.radius * s.theta_dot[j] * tangent;
  }
  return total;
}

/// Largest relative change of linear (.x) and angular (.y) momentum while a rod flies, bends, twists and
/// spins for 1000 steps.
Eigen::Vector2d momentum_drift() {
  constexpr int n = 31;
  RodProbe probe(slender_rod(1e-3, 0.7e-3, 1.0, 1e3, 0.01), nodes_on_x(n, 0.0, 1.0 / (n - 1)));
  for (int i = 0; i < n; ++i) {
    const double s = probe.state.x(0, i);
    probe.state.v.col(i) = Vec3(0.1, 0.3 + 0.8 * std::cos(2 * kPi * s), 0.5 * std::sin(5.0 * s) - 0.2);
    probe.state.theta_dot[i] = i + 1 < n ? 2.0 * std::sin(3.0 * s) : 0.0;
  }
  probe.options.dt = 2e-3;
  probe.options.relative_tolerance = 0.0;
  probe.options.force_tolerance = 1e-13;
  probe.options.max_iterations = 8;
  const Momentum start = momentum_of(probe.rod.material, probe.state);
  Eigen::Vector2d drift = Eigen::Vector2d::Zero();
  for (int k = 0; k < 1000; ++k) {
    if (!probe.rod.midpoint_step(probe.state, probe.memory, probe.options).sound)
      return Eigen::Vector2d::Constant(1.0);
    const Momentum now = momentum_of(probe.rod.material, probe.state);
    drift[0] = std::max(drift[0], (now.linear - start.linear).norm() / start.linear.norm());
    drift[1] = std::max(drift[1], (now.angular - start.angular).norm() / start.angular.norm());
  }
  return drift;
}

void list_momentum(ProblemList& list) {
  ValidationProblem p;
  p.source = "Conservation laws; rod in free flight, implicit midpoint rule, 1000 steps";
  p.name = "momentum-linear";
  p.quantity = "largest relative change of linear momentum";
  p.tolerance = 1e-10;
  list.push_back({p, [](ValidationProblem& r) { r.got = momentum_drift()[0]; }});
  p.name = "momentum-angular";
  p.quantity = "largest relative change of angular momentum";
  p.tolerance = 1e-5;
  list.push_back({p, [](ValidationProblem& r) { r.got = momentum_drift()[1]; }});
}

/// Period [s] of the slowest vibration along the axis (or about it, if `twist`) of a rod clamped at one end, 1 m long with a wave speed of
/// 1 m/s.
double wave_period(int edges, bool twist) {
  const double edge = 1.0 / (twist ? edges - 0.5 : edges), dt = 0.01;
  RodMaterial m;
  m.radius = 1e-3;
  m.density = 1.0 / (kPi * m.radius * m.radius);  // 1 kg/m
  m.EA = 1.0;
  m.GJ = 0.5 * m.radius * m.radius;  // the section's moment of inertia
  m.EI = 0.0;
  m.drag = 0.0;
  RodProbe probe(m, nodes_on_x(edges + 1, twist ? -0.5 * edge : 0.0, edge));
  probe.hold(0);
  probe.options.dt = dt;
  probe.options.relative_tolerance = 0.0;
  probe.options.force_tolerance = 1e-15;
  probe.options.max_iterations = 3;  // linear
  for (int i = 1; i <= edges; ++i) {
    if (twist) probe.hold_position(i);
    else probe.hold_angle(i);
    if (twist && i < edges) probe.state.theta_dot[i] = 1e-3 * std::sin(0.5 * kPi * edge * i);
    if (!twist) probe.state.v(0, i) = 1e-6 * std::sin(0.5 * kPi * edge * i);
  }
  const auto end = [&] { return twist ? probe.state.theta[edges - 1] : probe.state.x(0, edges) - 1.0; };
  double before = 0.0;
  for (int k = 1; k < 1000; ++k) {
    if (!probe.rod.midpoint_step(probe.state, probe.memory, probe.options).sound) break;
    const double after = end();
    if (k > 1 && before * after <= 0.0) return 2.0 * dt * (k - after / (after - before));
    before = after;
  }
  return 0.0;
}

void list_waves(ProblemList& list) {
  for (const bool twist : {false, true}) {
    ValidationProblem p;
    p.name = twist ? "twist-wave" : "stretch-wave";
    p.source = twist ? "d'Alembert: 4 L/c, c = sqrt(G/rho), one end clamped, the other free" : "d'Alembert: 4 L/c, c = sqrt(E/rho), one end clamped, the other free";
    p.quantity = "period of the slowest vibration, over L/c";
    p.expected = 4.0;
    p.tolerance = 1e-3;
    p.least_order = 1.8;
    list.push_back({p, [twist](ValidationProblem& r) {
                      r.got = wave_period(80, twist);
                      r.order = observed_order(wave_period(20, twist), wave_period(40, twist), r.got);
                    }});
  }
}

}  // namespace

void list_dynamics(ProblemList& list) {
  list_frequency(list);
  list_waves(list);
  list_momentum(list);
}

}  // namespace filum
