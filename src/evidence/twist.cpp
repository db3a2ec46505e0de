// Twist and what it makes of a rod: helices, writhing rings, localized buckling.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>

#include "evidence/problem_list.h"
#include "evidence/rod_probe.h"
#include "evidence/stability.h"

namespace filum {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Largest deviation of the twisting moment from M = C Th/L along a clamped rod that is pulled and turned at
/// one end.
double uniform_twist_error() {
  constexpr int n = 41;
  constexpr double edge = 1.0 / (n - 2), C = 0.7, turn = 3.0;  // 1 m between the middles of the clamped edges
  RodProbe probe(slender_rod(1.0, C, 1.0, 1e3, 1e-3), nodes_on_x(n, 0.0, edge));
  for (int i : {0, 1, n - 2, n - 1}) probe.hold_position(i);
  for (int j : {0, n - 2}) probe.hold_angle(j);
  probe.rod.boundary.target(0, n - 2) += 1e-4;
  probe.rod.boundary.target(0, n - 1) += 1e-4;
  probe.rod.boundary.target(3, n - 2) = turn;
  if (!probe.come_to_rest(1e3, 20, 1e-12)) return kNan;
  double worst = 0.0;
  for (int i = 1; i + 1 < n; ++i) worst = std::max(worst, std::abs(probe.moment_at(i) / (C * turn) - 1.0));
  return worst;
}

void list_uniform_twist(ProblemList& list) {
  ValidationProblem p;
  p.name = "twist-tension";
  p.source = "Saint-Venant: M = C Th/L everywhere in a straight rod, whatever its tension";
  p.quantity = "largest relative deviation of the twisting moment";
  p.tolerance = 1e-8;
  list.push_back({p, [](ValidationProblem& r) { r.got = uniform_twist_error(); }});
}

/// Flat ring of n edges and radius 1, cut and glued with the total twist `angle` [rad].
bool ring_is_stable(int n, double angle, double B, double C) {
  Points nodes(3, n + 2);  // the first edge once more at the end
  for (int i = 0; i < n + 2; ++i)
    nodes.col(i) = Vec3(std::cos(2 * kPi * i / n), std::sin(2 * kPi * i / n), 0.0);
  RodState s = RodState::from_nodes(nodes, n + 2);
  for (int j = 0; j <= n; ++j) s.theta[j] = angle * j / n;
  Eigen::Array<bool, 4, Eigen::Dynamic> held =
      Eigen::Array<bool, 4, Eigen::Dynamic>::Constant(4, n + 2, false);
  for (int i : {0, 1, n, n + 1}) held.col(i).head<3>() = true;
  held(3, 0) = held(3, n) = true;
  held(2, n / 2) =
      true;  // else the ring could turn freely about the glued edge while it rolls about its own axis
  return is_stable(slender_rod(B, C, 2 * kPi, 2e3, 1.0), s, held);
}

double critical_ring_twist(int n, double C) {
  const double expected = 2.0 * kPi * std::sqrt(3.0) / C;
  return critical_load(0.3 * expected, 2.0 * expected,
                       [&](double angle) { return ring_is_stable(n, angle, 1.0, C); });
}

void list_ring(ProblemList& list, const char* label, double C, const char* ratio) {
  ValidationProblem p;
  p.name = std::string("michell-ring-").append(label);
  p.source = "Michell 1889, Zajac, J. Appl. Mech. 29:136, 1962: 2 pi sqrt(3) B/C";
  p.quantity = std::string("twist at which a flat ring writhes, C/B = ").append(ratio);
  p.unit = "rad";
  p.expected = 2.0 * kPi * std::sqrt(3.0) / C;
  p.tolerance = 5e-3;
  p.least_order = 1.8;
  list.push_back({p, [C](ValidationProblem& r) {
                    r.got = critical_ring_twist(160, C);
                    r.order = observed_order(critical_ring_twist(40, C), critical_ring_twist(80, C), r.got);
                  }});
}

/// Zero at the critical moment M of a straight rod of length 1 and B = 1 clamped at both ends under tension
/// T: the determinant of w = w' = 0 at s = -1/2 and 1/2 for B w'''' - i M w''' - T w'' = 0.
double helix_determinant(double M, double T) {
  const double root = std::sqrt(0.25 * M * M - T), p = 0.5 * M + root, q = 0.5 * M - root, H = 0.5;
  return q * std::sin(q * H) * (std::sin(p * H) - p * H * std::cos(p * H)) -
         p * std::sin(p * H) * (std::sin(q * H) - q * H * std::cos(q * H));
}

double greenhill_moment(double tension) {
  const double T = std::max(tension, 1e-6);  // the determinant is 0 / 0 at no tension
  double low = 2.0 * std::sqrt(T) * (1.0 + 1e-6);
  const double step = 0.01;
  while (helix_determinant(low, T) * helix_determinant(low + step, T) > 0.0) low += step;
  double high = low + step;
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (low + high);
    (helix_determinant(low, T) * helix_determinant(middle, T) > 0.0 ? low : high) = middle;
  }
  return low;
}

double critical_moment(int n, double T) {
  constexpr double C = 0.7;
  const double edge = 1.0 / (n - 2);  // 1 m between the middles of the clamped edges
  const RodMaterial m = slender_rod(1.0, C, 1.0, 1e4, 1.0);
  RodState s = RodState::from_nodes(nodes_on_x(n, 0.0, edge), n);
  s.rest_length /= 1.0 + T / m.EA;
  Eigen::Array<bool, 4, Eigen::Dynamic> held = Eigen::Array<bool, 4, Eigen::Dynamic>::Constant(4, n, false);
  for (int i : {0, 1, n - 2, n - 1}) held.col(i).head<3>() = true;
  held(3, 0) = held(3, n - 2) = true;
  const double expected = greenhill_moment(T);
  return critical_load(0.3 * expected, 2.0 * expected, [&](double M) {
    for (int j = 0; j + 1 < n; ++j) s.theta[j] = M / C * edge * j;
    return is_stable(m, s, held);
  });
}

void list_greenhill(ProblemList& list, double T) {
  ValidationProblem p;
  char text[120];
  std::snprintf(text, sizeof text, "greenhill-%g", T);
  p.name = text;
  p.source =
      "Greenhill 1883, B w'''' - i M w''' - T w'' = 0, both ends clamped (without tension tan x = x, M L/B = "
      "2 x = 8.987)";
  std::snprintf(text, sizeof text, "M L/B at which a straight rod turns into a helix, T L^2/B = %g", T);
  p.quantity = text;
  p.expected = greenhill_moment(T);
  p.tolerance = 5e-3;
  p.least_order = 1.8;
  list.push_back({p, [T](ValidationProblem& r) {
                    r.got = critical_moment(322, T);
                    r.order = observed_order(critical_moment(82, T), critical_moment(162, T), r.got);
                  }});
}

/// Twisting moment of a long rod whose clamped ends came 3 closer and were turned by 27 turns against each
/// other.
double localized_moment(int n) {
  constexpr double L = 100.0, slack = 3.0, turns = 27.0;
  const double edge = L / (n - 2);
  RodProbe probe(slender_rod(1.345, 0.789, L, 1e4, 1.0), nodes_on_x(n, -0.5 * edge, edge));
  Points nodes = probe.state.x;
  for (int i = 2; i < n - 2; ++i) nodes.col(i) += Vec3(0, 1e-3, 1e-3) * std::sin(kPi * nodes(0, i) / L);
  const Eigen::VectorXd rest = probe.state.rest_length;
  probe.state = RodState::from_nodes(nodes, n);
  probe.state.rest_length = rest;
  for (int i : {0, 1, n - 2, n - 1}) probe.hold_position(i);
  for (int j : {0, n - 2}) probe.hold_angle(j);
  constexpr int kParts = 90;
  bool rests = false;
  probe.options.relative_tolerance = 1e-6;
  for (int k = 1; k <= kParts; ++k) {
    const double part = static_cast<double>(k) / kParts, come = slack * std::min(1.0, 4.0 * part);
    for (int i : {n - 2, n - 1}) probe.rod.boundary.target(0, i) = nodes(0, i) - come;
    probe.rod.boundary.target(3, n - 2) = 2.0 * kPi * turns * part;
    rests = probe.come_to_rest(1e3, k == kParts ? 300 : 2, 1e-6);
  }
  return rests ? probe.moment_at(n / 2) : kNan;
}

void list_localized(ProblemList& list) {
  ValidationProblem p;
  p.name = "localized-helix";
  p.source =
      "van der Heijden & Thompson, Nonlinear Dyn. 21:71, 2000: infinite rod, B 1.345 N m2, C 0.789 N m2, 100 "
      "m, 27 turns, 3 m shorter";
  p.quantity = "twisting moment of the localized helix";
  p.unit = "N m";
  p.expected = 1.325383;
  p.tolerance = 1e-2;
  list.push_back({p, [](ValidationProblem& r) { r.got = localized_moment(402); }});
}

}  // namespace

void list_twist(ProblemList& list) {
  list_uniform_twist(list);
  list_ring(list, "2-3", 2.0 / 3.0, "2/3");
  list_ring(list, "1-1.3", 1.0 / 1.3, "1/1.3");
  list_ring(list, "1", 1.0, "1");
  for (double T : {0.0, 10.0, 100.0}) list_greenhill(list, T);
  list_localized(list);
}

}  // namespace filum
