// Bending at rest. The expected numbers of the heavy and the loaded cantilever are those of the plane
// elastica B th'' = -(q (L - s) + P) cos th, th(0) = 0, th'(L) = 0, solved with Runge-Kutta 4 in 4000 steps.
// Those of the strut are Euler's in complete elliptic integrals K, E of modulus k = sin(alpha/2) (Love, A Treatise on
// the Mathematical Theory of Elasticity, 1927, art. 263), alpha the angle by which pinned ends turn:
//   P/P_cr = (2 K/pi)^2 ,  P_cr = pi^2 B/L^2 ,  shortening/L = 2 (1 - E/K) ,  deflection of the middle/L = k/K .

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <utility>

#include "evidence/problem_list.h"
#include "base/numbers.h"
#include "evidence/rod_probe.h"
#include "evidence/stability.h"

namespace filum {
namespace {

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

/// A polygon of n corners against what its formula says, (tan x/x)^2 with x = pi/n: the curvature at a corner is 2 tan x over the edge.
void list_polygon(ProblemList& list, int n) {
  ValidationProblem p;
  p.name = "polygon-energy-" + std::to_string(n);
  p.source = "Curvature binormal, |kb| = 2 tan(x), x = pi/n (Bergou et al., ACM TOG 27(3):63, 2008): U/(pi B/R) = (tan x/x)^2";
  p.quantity = "bending energy / (pi B/R) of a regular polygon of " + std::to_string(n) + " corners as long as the circle";
  p.expected = std::pow(std::tan(kPi / n) * n / kPi, 2);
  p.tolerance = 1e-12;
  p.note = "no order: the formula is that of the polygon itself; bending-energy has the order towards the circle";
  list.push_back({p, [n](ValidationProblem& r) { r.got = ring_energy(n); }});
}

/// The tip of a cantilever, over its length; the angle below the horizontal.
struct Tip {
  double reach = kNaN, drop = kNaN, angle = kNaN;  // [1], [1], [deg]
};

/// Clamped in the middle of its first edge: the node behind that carries the bending from there on.
Tip loaded_tip(int edges, double gamma, double alpha) {
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
    if (k == 8 && !rests) return {};
  }
  const Vec3 tip = probe.state.x.col(edges), last = tip - Vec3(probe.state.x.col(edges - 1));
  return {tip.x(), -tip.z(), std::atan2(-last.z(), last.x()) * 180.0 / kPi};
}

/// Each is solved once, whatever is asked of it.
const Tip& solved_tip(int edges, double gamma, double alpha) {
  static std::map<std::array<double, 3>, Tip> solved;
  const std::array<double, 3> key{static_cast<double>(edges), gamma, alpha};
  const auto found = solved.find(key);
  return found != solved.end() ? found->second : solved.emplace(key, loaded_tip(edges, gamma, alpha)).first->second;
}

/// A load and where it leads the tip: reach and drop over the length, angle [deg].
struct LoadedTip {
  double load, reach, drop, angle;
};

void list_cantilever(ProblemList& list, const char* kind, const char* source, bool heavy, const LoadedTip& c) {
  struct Measure {
    const char *label, *quantity, *unit;
    double Tip::*of;
    double expected;
  };
  for (const Measure& m : {Measure{"", "tip drop / L", "1", &Tip::drop, c.drop}, Measure{"reach-", "tip reach / L", "1", &Tip::reach, c.reach},
                           Measure{"angle-", "angle of the tip", "deg", &Tip::angle, c.angle}}) {
    ValidationProblem p;
    char text[80];
    std::snprintf(text, sizeof text, "cantilever-%s-%s%g", kind, m.label, c.load);
    p.name = text;
    p.source = source;
    std::snprintf(text, sizeof text, "%s at %s = %g", m.quantity, heavy ? "q L^3/B" : "P L^2/B", c.load);
    p.quantity = text;
    p.unit = m.unit;
    p.expected = m.expected;
    p.tolerance = 5e-3;
    p.least_order = 1.8;
    const double gamma = heavy ? c.load : 0.0, alpha = heavy ? 0.0 : c.load, Tip::*of = m.of;
    list.push_back({p, [gamma, alpha, of](ValidationProblem& r) {
                      const auto at = [&](int edges) { return solved_tip(edges, gamma, alpha).*of; };
                      r.got = at(80);
                      r.order = observed_order(at(20), at(40), r.got);
                    }});
  }
}

void list_cantilevers(ProblemList& list) {
  constexpr const char* kHeavy = "Plane elastica under its own weight, Runge-Kutta 4";
  for (const LoadedTip& c : {LoadedTip{0.1, 0.99991, 0.01250, 0.955}, LoadedTip{1, 0.99125, 0.12347, 9.460}, LoadedTip{2, 0.96689, 0.23851, 18.426},
                             LoadedTip{5, 0.84666, 0.49591, 39.935}, LoadedTip{10, 0.65635, 0.70020, 60.312}, LoadedTip{20, 0.44523, 0.82988, 76.748},
                             LoadedTip{50, 0.24501, 0.90792, 87.459}, LoadedTip{100, 0.15922, 0.93752, 89.617}})
    list_cantilever(list, "self-weight", kHeavy, true, c);
  constexpr const char* kLoaded = "Bisshopp & Drucker, Q. Appl. Math. 3:272, 1945, and Runge-Kutta 4";
  for (const LoadedTip& c : {LoadedTip{0.25, 0.99588, 0.08275, 7.121}, LoadedTip{1, 0.94357, 0.30172, 26.434}, LoadedTip{2, 0.83936, 0.49346, 44.791},
                             LoadedTip{5, 0.61237, 0.71379, 69.635}, LoadedTip{10, 0.44500, 0.81061, 81.949}})
    list_cantilever(list, "tip-load", kLoaded, false, c);
}

/// What a strut of length 1 and B = 1 shows whose pinned ends have turned by a given angle.
struct Strut {
  double load = kNaN, shortening = kNaN, deflection = kNaN;  // over P_cr, over L, over L
};

/// A pinned strut of an odd number of edges, bowed a little: the middle edge lies along the line of the load.
RodProbe bowed_strut(int edges) {
  const Points nodes = nodes_on_x(edges + 1, 0.0, 1.0 / edges);
  RodProbe probe(slender_rod(1.0, 1.0, 1.0, 1e4, 1e-3), nodes);
  Points bowed = nodes;
  for (int i = 0; i <= edges; ++i) bowed(2, i) = 1e-2 * std::sin(kPi * nodes(0, i));
  const Eigen::VectorXd straight = probe.state.rest_length;
  probe.state = RodState::from_nodes(bowed, edges + 1);
  probe.state.rest_length = straight;
  probe.hold(0);
  probe.hold_position(edges);
  return probe;
}

/// Angle [rad] by which the rod has turned at its first node, to whichever side it bows. A pinned end has no curvature: the even parabola
/// through the angles at the middles of the first two edges.
double end_angle(const RodState& s) {
  const auto angle = [&](int j) {
    const Vec3 e = s.x.col(j + 1) - s.x.col(j);
    return std::atan2(e.z(), e.x());
  };
  return std::abs(9.0 * angle(0) - angle(1)) / 8.0;
}

/// Brings the far end of the strut in from `from` to `to` of its length; true if it rests there.
bool shorten(RodProbe& probe, double from, double to, int parts) {
  const int edges = probe.state.n - 1;
  bool rests = false;
  for (int k = 1; k <= parts; ++k) {
    probe.rod.boundary.target(0, edges) = 1.0 - (from + (to - from) * k / parts);
    rests = probe.come_to_rest(10.0, 60, 1e-9);
  }
  return rests;
}

/// The ends are brought together until they have turned by `alpha` [rad]: by secants from near the shortening of the first mode of
/// buckling, whose tangent turns as alpha cos(pi s), 1 - J0(alpha).
Strut turned_strut(int edges, double alpha) {
  RodProbe probe = bowed_strut(edges);
  double here = 1.0 - std::cyl_bessel_j(0.0, alpha), last = 0.99 * here;
  if (!shorten(probe, 0.0, last, 40)) return {};
  double angle_last = end_angle(probe.state);
  for (int k = 0; k < 12; ++k) {
    if (!shorten(probe, last, here, 4)) return {};
    const double angle = end_angle(probe.state);
    if (std::abs(angle - alpha) < 1e-9) break;
    const double next = here + (alpha - angle) * (here - last) / (angle - angle_last);
    last = std::exchange(here, next);
    angle_last = angle;
  }
  const int middle = edges / 2;
  return {-edge_tension(probe.rod.material, probe.state, middle) / (kPi * kPi), 1.0 - probe.state.x(0, edges),
          0.5 * std::abs(probe.state.x(2, middle) + probe.state.x(2, middle + 1))};
}

const Strut& solved_strut(int edges, int degrees) {
  static std::map<std::pair<int, int>, Strut> solved;
  const auto found = solved.find({edges, degrees});
  return found != solved.end() ? found->second : solved.emplace(std::pair(edges, degrees), turned_strut(edges, degrees * kPi / 180.0)).first->second;
}

void list_strut(ProblemList& list, int alpha) {
  const double k = std::sin(0.5 * alpha * kPi / 180.0), K = std::comp_ellint_1(k), E = std::comp_ellint_2(k);
  struct Measure {
    const char *label, *quantity;
    double Strut::*of;
    double expected;
  };
  for (const Measure& m : {Measure{"", "P/Pcr", &Strut::load, std::pow(2.0 * K / kPi, 2)},
                           Measure{"shortening-", "shortening / L", &Strut::shortening, 2.0 * (1.0 - E / K)},
                           Measure{"deflection-", "deflection of the middle / L", &Strut::deflection, k / K}}) {
    ValidationProblem p;
    p.name = std::string("euler-strut-") + m.label + std::to_string(alpha);
    p.source =
        "Euler's elastica, pinned ends: P/Pcr = (2K/pi)^2, shortening/L = 2(1 - E/K), w/L = k/K, k = sin(alpha/2) (Love "
        "1927, art. 263)";
    p.quantity = std::string(m.quantity) + " with the ends turned by " + std::to_string(alpha) + " deg";
    p.expected = m.expected;
    p.tolerance = 5e-3;
    p.least_order = 1.8;
    list.push_back({p, [alpha, of = m.of](ValidationProblem& r) {
                      r.got = solved_strut(81, alpha).*of;
                      r.order = order_of_errors(solved_strut(41, alpha).*of - r.expected, r.got - r.expected, 81.0 / 41.0);
                    }});
  }
}

/// P L^2/B at which a straight rod buckles between clamped or pinned ends.
double buckling_load(int edges, bool clamped) {
  const int n = edges + (clamped ? 2 : 1);  // 1 m between the pins, or the middles of the clamped edges
  const double edge = 1.0 / edges;
  const RodMaterial m = slender_rod(1.0, 1.0, 1.0, 1e4, 1.0);
  RodState s = RodState::from_nodes(nodes_on_x(n, 0.0, edge), n);
  Eigen::Array<bool, 4, Eigen::Dynamic> held = Eigen::Array<bool, 4, Eigen::Dynamic>::Constant(4, n, false);
  for (int i : {0, n - 1}) held.col(i).head<3>() = true;
  if (clamped)
    for (int i : {1, n - 2}) held.col(i).head<3>() = true;
  held(3, 0) = held(3, n - 2) = true;
  const double expected = (clamped ? 4.0 : 1.0) * kPi * kPi;
  return critical_load(0.5 * expected, 1.5 * expected, [&](double P) {
    s.rest_length.setConstant(edge / (1.0 - P / m.EA));
    return is_stable(m, s, held);
  });
}

void list_buckling(ProblemList& list) {
  for (const bool clamped : {false, true}) {
    ValidationProblem p;
    p.name = clamped ? "euler-buckling-clamped" : "euler-buckling-pinned";
    p.source = clamped ? "Euler 1744, both ends clamped: 4 pi^2" : "Euler 1744, both ends pinned: pi^2";
    p.quantity = "P L^2/B at which a straight rod buckles";
    p.expected = (clamped ? 4.0 : 1.0) * kPi * kPi;
    p.tolerance = 5e-3;
    p.least_order = 1.8;
    list.push_back({p, [clamped](ValidationProblem& r) {
                      r.got = buckling_load(80, clamped);
                      r.order = observed_order(buckling_load(20, clamped), buckling_load(40, clamped), r.got);
                    }});
  }
}

}  // namespace

void list_elastica(ProblemList& list) {
  list_ring_energy(list);
  for (const int n : {20, 50, 100}) list_polygon(list, n);
  list_cantilevers(list);
  list_buckling(list);
  for (const int alpha : {20, 40, 60, 90, 120}) list_strut(list, alpha);
}

}  // namespace filum
