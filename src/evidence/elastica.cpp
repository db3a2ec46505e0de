// Bending at rest. The expected numbers of the heavy and the loaded cantilever are those of the plane
// elastica B th'' = -(q (L - s) + P) cos th, th(0) = 0, th'(L) = 0, solved with Runge-Kutta 4 in 4000 steps.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>

#include "evidence/problem_list.h"
#include "evidence/rod_probe.h"

namespace filum {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Energy of a straight rod closed into a regular polygon of n corners over that of the circle, B pi / R.
double ring_energy(int n) {
  const double edge = 2.0 * kPi / n;  // [m], of arc, R = 1
  Points nodes(3, n + 2);             // the first edge once more at the end: n corners
  for (int i = 0; i < n + 2; ++i) nodes.col(i) = Vec3(std::cos(edge * i), std::sin(edge * i), 0.0);
  RodMaterial m;
  m.EI = 1.0;
  m.GJ = 0.7;
  m.EA = 0.0;
  RodState s = RodState::from_nodes(nodes, n + 2);
  s.rest_length.setConstant(edge);
  RodGeometry g(n + 2);
  update_geometry(s, s.x, s.theta, g);
  return elastic_energy(m, s, g) / kPi;
}

void list_ring_energy(ProblemList& list) {
  ValidationProblem p;
  p.name = "bending-energy";
  p.source =
      "Circle bent from a straight rod, U = pi B/R (Euler-Bernoulli); polygon of 100 corners, order from 25, "
      "50, 100";
  p.quantity = "bending energy / (pi B/R)";
  p.expected = 1.0;
  p.tolerance = 1e-3;
  p.least_order = 1.9;
  list.push_back({p, [](ValidationProblem& r) {
                    r.got = ring_energy(100);
                    r.order = observed_order(ring_energy(25), ring_energy(50), r.got);
                  }});
}

/// Drop of the tip / L of a cantilever, clamped in the middle of its first edge: the node behind that carries
/// the bending from there on.
double tip_drop(int edges, double gamma, double alpha) {
  const double edge = 1.0 / (edges - 0.5);
  RodProbe probe(slender_rod(1.0, 1.0, 1.0, 1e3, std::max(gamma, 1e-3)),
                 nodes_on_x(edges + 1, -0.5 * edge, edge));
  probe.hold(0);
  probe.hold(1);
  for (int k = 1; k <= 8; ++k) {  // the load in eight parts
    const double part = k / 8.0;
    probe.options.gravity = Vec3(0, 0, gamma > 0.0 ? -part : 0.0);
    probe.rod.boundary.load(2, edges) = -part * alpha;
    const bool rests = probe.come_to_rest(1e3, 40, 1e-10);
    if (k == 8 && !rests) return kNan;
  }
  return -probe.state.x(2, edges);
}

void list_cantilever(ProblemList& list, const char* kind, const char* source, bool heavy, double load,
                     double drop) {
  ValidationProblem p;
  char text[60];
  std::snprintf(text, sizeof text, "cantilever-%s-%g", kind, load);
  p.name = text;
  p.source = source;
  std::snprintf(text, sizeof text, "tip drop / L at %s = %g", heavy ? "q L^3/B" : "P L^2/B", load);
  p.quantity = text;
  p.expected = drop;
  p.tolerance = 5e-3;
  p.least_order = 1.8;
  list.push_back({p, [heavy, load](ValidationProblem& r) {
                    const auto drop_with = [&](int edges) {
                      return tip_drop(edges, heavy ? load : 0.0, heavy ? 0.0 : load);
                    };
                    r.got = drop_with(80);
                    r.order = observed_order(drop_with(20), drop_with(40), r.got);
                  }});
}

/// P / P_cr of a pinned strut whose ends have come closer by `shortening` of its length.
double strut_load(int edges, double shortening) {
  Points nodes = nodes_on_x(edges + 1, 0.0, 1.0 / edges);
  RodProbe probe(slender_rod(1.0, 1.0, 1.0, 1e4, 1e-3), nodes);
  for (int i = 0; i <= edges; ++i)
    probe.state.x(2, i) = 1e-2 * std::sin(kPi * nodes(0, i));  // which way to bow
  probe.state = [&] {
    RodState bowed = RodState::from_nodes(probe.state.x, edges + 1);
    bowed.rest_length = probe.state.rest_length;
    return bowed;
  }();
  probe.hold(0);
  probe.hold_position(edges);
  constexpr int kParts = 40;
  bool rests = false;
  for (int k = 1; k <= kParts; ++k) {
    probe.rod.boundary.target(0, edges) = 1.0 - shortening * k / kParts;
    rests = probe.come_to_rest(10.0, 60, 1e-9);
  }
  if (!rests) return kNan;
  return -edge_tension(probe.rod.material, probe.state, edges / 2) / (kPi * kPi);
}

void list_strut(ProblemList& list, int alpha, double shortening, double load) {
  ValidationProblem p;
  char text[60];
  std::snprintf(text, sizeof text, "euler-strut-%d", alpha);
  p.name = text;
  p.source =
      "Euler's elastica, pinned ends: P/Pcr = (2K/pi)^2, shortening/L = 2(1 - E/K), k = sin(alpha/2) (Love "
      "1927, art. 263)";
  std::snprintf(text, sizeof text, "P/Pcr with the ends turned by %d deg", alpha);
  p.quantity = text;
  p.expected = load;
  p.tolerance = 5e-3;
  p.least_order = 1.8;
  list.push_back({p, [shortening](ValidationProblem& r) {
                    r.got =
                        strut_load(81, shortening);  // odd: the middle edge lies along the line of the load
                    r.order = observed_order(strut_load(21, shortening), strut_load(41, shortening), r.got);
                  }});
}

}  // namespace

void list_elastica(ProblemList& list) {
  list_ring_energy(list);
  constexpr const char* kHeavy = "Plane elastica under its own weight, Runge-Kutta 4";
  constexpr std::array<std::array<double, 2>, 6> kWeights = {
      {{1, 0.12347}, {5, 0.49591}, {10, 0.70020}, {20, 0.82988}, {50, 0.90792}, {100, 0.93752}}};
  for (const auto& [gamma, drop] : kWeights) list_cantilever(list, "self-weight", kHeavy, true, gamma, drop);
  constexpr const char* kLoaded = "Bisshopp & Drucker, Q. Appl. Math. 3:272, 1945, and Runge-Kutta 4";
  constexpr std::array<std::array<double, 2>, 4> kLoads = {
      {{1, 0.30172}, {2, 0.49346}, {5, 0.71379}, {10, 0.81061}}};
  for (const auto& [alpha, drop] : kLoads) list_cantilever(list, "tip-load", kLoaded, false, alpha, drop);
  list_strut(list, 20, 0.03027, 1.01540);
  list_strut(list, 60, 0.25898, 1.15172);
  list_strut(list, 90, 0.54305, 1.39320);
  list_strut(list, 120, 0.87684, 1.88480);
}

}  // namespace filum
