// Motion without loss: the implicit midpoint rule on vibrating and on tumbling rods.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "evidence/problem_list.h"
#include "base/numbers.h"
#include "evidence/rod_probe.h"

namespace filum {
namespace {

/// Roots of cos(b) cosh(b) = -1: the first bending vibrations of a cantilever of length 1, omega = b^2 sqrt(B/(rho A)).
constexpr std::array<double, 3> kModes = {1.875104069, 4.694091133, 7.854757438};

/// Shape of a bending vibration of a cantilever of length 1 at s; tip 2 or -2.
double mode_shape(double b, double s) {
  const double ratio = (std::cosh(b) + std::cos(b)) / (std::sinh(b) + std::sin(b));
  return std::cosh(b * s) - std::cos(b * s) - ratio * (std::sinh(b * s) - std::sin(b * s));
}

/// Angular frequency [rad/s] of vibration `mode` from the times at which the tip of a small one passes the middle.
double cantilever_frequency(int edges, int mode) {
  const double b = kModes[static_cast<std::size_t>(mode)], slower = std::pow(kModes[0] / b, 2);
  const double edge = 1.0 / (edges - 0.5), dt = 0.05 * slower;
  const RodMaterial m = [] {
    RodMaterial wire = RodMaterial::round_wire(0.02, 1e5, 0.5, 500.0);
    wire.drag = 0.0;
    return wire;
  }();
  RodProbe probe(m, nodes_on_x(edges + 1, -0.5 * edge, edge));
  probe.hold(0);
  probe.hold(1);
  probe.options.dt = dt;
  for (int i = 2; i <= edges; ++i) probe.state.v(2, i) = 5e-4 * mode_shape(b, probe.state.x(0, i));
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

void list_frequency(ProblemList& list, int mode, const char* label, const char* which) {
  const double root = kModes[static_cast<std::size_t>(mode)] * kModes[static_cast<std::size_t>(mode)];
  ValidationProblem p;
  p.name = std::string("cantilever-frequency") + label;
  p.source =
      "Euler-Bernoulli, omega = b^2 sqrt(B/(rho A))/L^2, b^2 = 3.51602, 22.0345, 61.697; rod of DisMech's cantilever: 1 m, radius "
      "20 mm, 0.1 MPa, 500 kg/m3";
  p.quantity = std::string(which) + " angular frequency";
  p.unit = "rad/s";
  p.expected = root * std::sqrt(1e5 * std::pow(0.02, 2) / 4.0 / 500.0);
  p.tolerance = 1e-2;
  p.least_order = 1.8;
  const int edges = mode == 0 ? 40 : 80;
  list.push_back({p, [mode, edges](ValidationProblem& r) {
                    r.got = cantilever_frequency(edges, mode);
                    r.order = observed_order(cantilever_frequency(edges / 4, mode), cantilever_frequency(edges / 2, mode), r.got);
                  }});
}

/// Sum of m v and of x cross m v about the origin [kg m/s], [kg m2/s].
struct Momentum {
  Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();
};

Momentum momentum_of(const RodMaterial& m, const RodState& s) {
  Momentum total;
  for (int j = 0; j + 1 < s.n; ++j)
    for (int i = j; i <= j + 1; ++i) {
      const Vec3 share = 0.5 * m.mass_per_length() * s.rest_length[j] * s.v.col(i);
      total.linear += share;
      total.angular += Vec3(s.x.col(i)).cross(share);
    }
  return total;
}

/// [kg m2/s] of edge j about its tangent.
double spin_of(const RodMaterial& m, const RodState& s, int j) {
  return 0.5 * m.mass_per_length() * m.radius * m.radius * s.rest_length[j] * s.theta_dot[j];
}

/// A rod that bends, twists and spins in free flight for 2 s, 400 steps of the implicit midpoint rule or of backward Euler.
struct Flight {
  Flight(bool with_spin, bool midpoint_rule) : midpoint(midpoint_rule), probe(thrown(with_spin)) {
    const RodMaterial& m = probe.rod.material;
    start = momentum_of(m, probe.state);
    spin_start = spin();
    for (int k = 0; k < 400; ++k) {
      const RodState before = probe.state;
      sound = sound && (midpoint ? probe.rod.midpoint_step(probe.state, probe.memory, probe.options)
                                 : probe.rod.step(probe.state, probe.memory, probe.options)).sound;
      for (int j = 0; j + 1 < before.n; ++j) {
        const Vec3 e = before.x.col(j + 1) - before.x.col(j) + probe.state.x.col(j + 1) - probe.state.x.col(j);
        spun_up += (spin_of(m, probe.state, j) - spin_of(m, before, j)) * e.normalized();  // the tangent in the middle of the step
      }
      note();
    }
  }

  /// Without the inertia of its section's spin, the rod is a line of mass.
  static RodProbe thrown(bool with_spin) {
    constexpr int n = 31;
    RodMaterial m = slender_rod(1e-3, 0.7e-3, 1.0, 1e3, 0.01);
    if (!with_spin) {
      m.density *= std::pow(m.radius / 1e-9, 2);
      m.radius = 1e-9;
    }
    RodProbe probe(m, nodes_on_x(n, -0.5, 1.0 / (n - 1)));
    for (int i = 0; i < n; ++i) {
      const double s = probe.state.x(0, i) + 0.5;
      probe.state.v.col(i) = Vec3(0.1, 0.3 + 0.8 * std::cos(2 * kPi * s), 0.5 * std::sin(5.0 * s) - 0.2);
      probe.state.theta_dot[i] = i + 1 < n ? 2.0 * std::sin(3.0 * s) : 0.0;
    }
    probe.options.dt = 5e-3;
    probe.options.relative_tolerance = probe.options.force_tolerance = 0.0;  // to rounding
    probe.options.max_iterations = 8;
    return probe;
  }

  Vec3 spin() const {
    Vec3 sum = Vec3::Zero();
    for (int j = 0; j + 1 < probe.state.n; ++j)
      sum += spin_of(probe.rod.material, probe.state, j) * (probe.state.x.col(j + 1) - probe.state.x.col(j)).normalized();
    return sum;
  }

  void note() {
    const Momentum now = momentum_of(probe.rod.material, probe.state);
    const auto worst = [this](double& so_far, const Vec3& change, const Vec3& whole) {
      so_far = sound ? std::max(so_far, change.norm() / whole.norm()) : std::nan("");
    };
    worst(linear, now.linear - start.linear, start.linear);
    worst(angular, now.angular - start.angular, start.angular);
    worst(balance, now.angular + spun_up - start.angular, start.angular);
    worst(with_spin_axis, now.angular + spin() - start.angular - spin_start, start.angular);
  }

  bool midpoint, sound = true;
  RodProbe probe;
  Momentum start;
  Vec3 spin_start, spun_up = Vec3::Zero();
  double linear = 0.0, angular = 0.0;  // [1], largest change so far over the value at the start
  double balance = 0.0;                // [1], of x cross m v and what the couples of twist did to the spins
  double with_spin_axis = 0.0;         // [1], of x cross m v and the spins along their edges
};

/// The rod's equations turn the spin of a section about a fixed axis at any moment: they leave out the couple I theta' t' that turns the axis
/// along with the rod. So x cross m v is conserved where the section has no inertia, and else together with the sum of t d(I theta').
void list_momentum(ProblemList& list) {
  ValidationProblem p;
  p.tolerance = 1e-12;
  p.note = "no order: conserved on any mesh and with any step, to rounding";
  p.source = "Conservation of momentum; rod in free flight for 2 s, implicit midpoint rule, 400 steps";
  p.name = "momentum-linear";
  p.quantity = "largest relative change of linear momentum";
  list.push_back({p, [](ValidationProblem& r) { r.got = Flight(true, true).linear; }});
  p.name = "momentum-linear-euler";
  p.source = "Conservation of momentum; rod in free flight for 2 s, backward Euler, 400 steps";
  list.push_back({p, [](ValidationProblem& r) { r.got = Flight(true, false).linear; }});
  p.name = "momentum-angular";
  p.source = "Conservation of angular momentum; rod in free flight for 2 s, implicit midpoint rule, 400 steps";
  p.quantity = "largest relative change of angular momentum, the rod a line of mass";
  list.push_back({p, [](ValidationProblem& r) { r.got = Flight(false, true).angular; }});
  p.name = "momentum-angular-spin";
  p.quantity = "largest relative change of angular momentum and of what the couples of twist gave to the sections' spin";
  list.push_back({p, [](ValidationProblem& r) {
                    const Flight flight(true, true);
                    r.got = flight.balance;
                    char text[160];
                    std::snprintf(text, sizeof text, "; the spins counted along their edges change it by %.1e: the couple that turns their axes is neglected",
                                  flight.with_spin_axis);
                    r.note += text;
                  }});
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
  list_frequency(list, 0, "", "first");
  list_frequency(list, 1, "-2", "second");
  list_frequency(list, 2, "-3", "third");
  list_waves(list);
  list_momentum(list);
}

}  // namespace filum
