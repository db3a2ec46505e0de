// Twist and what it makes of a rod: helices and writhing rings.

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "evidence/linking.h"
#include "base/numbers.h"
#include "evidence/problem_list.h"
#include "evidence/rod_probe.h"
#include "evidence/stability.h"

namespace filum {
namespace {

/// A clamped rod that is pulled and turned at one end: largest relative deviation of its twisting moment from M = C Th/L, and its writhe.
struct TwistedStraight {
  double moment_error = kNaN, writhe = kNaN;
};

TwistedStraight twisted_straight() {
  constexpr int n = 41;
  constexpr double edge = 1.0 / (n - 2), C = 0.7, turn = 3.0;  // 1 m between the middles of the clamped edges
  RodProbe probe(slender_rod(1.0, C, 1.0, 1e3, 1e-3), nodes_on_x(n, 0.0, edge));
  for (int i : {0, 1, n - 2, n - 1}) probe.hold_position(i);
  for (int j : {0, n - 2}) probe.hold_angle(j);
  probe.rod.boundary.target(0, n - 2) += 1e-4;
  probe.rod.boundary.target(0, n - 1) += 1e-4;
  probe.rod.boundary.target(3, n - 2) = turn;
  if (!probe.come_to_rest(1e3, 20, 1e-12)) return {};
  double worst = 0.0;
  for (int i = 1; i + 1 < n; ++i) worst = std::max(worst, std::abs(probe.moment_at(i) / (C * turn) - 1.0));
  return {worst, writhe(probe.state.x)};
}

void list_uniform_twist(ProblemList& list) {
  ValidationProblem p;
  p.name = "twist-tension";
  p.source = "Saint-Venant: M = C Th/L everywhere in a straight rod, whatever its tension";
  p.quantity = "largest relative deviation of the twisting moment";
  p.tolerance = 1e-8;
  p.note = "no order: uniform twist is exact on any mesh";
  list.push_back({p, [](ValidationProblem& r) { r.got = twisted_straight().moment_error; }});
  p.name = "twist-tension-writhe";
  p.quantity = "writhe of the rod, which stays straight";
  list.push_back({p, [](ValidationProblem& r) { r.got = twisted_straight().writhe; }});
}

/// Flat ring of n edges and radius R [m], cut and glued with the total twist `angle` [rad].
bool ring_is_stable(int n, double angle, const RodMaterial& m, double R) {
  Points nodes(3, n + 2);  // the first edge once more at the end
  for (int i = 0; i < n + 2; ++i)
    nodes.col(i) = R * Vec3(std::cos(2 * kPi * i / n), std::sin(2 * kPi * i / n), 0.0);
  RodState s = RodState::from_nodes(nodes, n + 2);
  for (int j = 0; j <= n; ++j) s.theta[j] = angle * j / n;
  HeldCoordinates held = HeldCoordinates::Constant(4, n + 2, false);
  for (int i : {0, 1, n, n + 1}) held.col(i).head<3>() = true;
  held(3, 0) = held(3, n) = true;
  held(2, n / 2) =
      true;  // else the ring could turn freely about the glued edge while it rolls about its own axis
  return is_stable(m, s, held);
}

double critical_ring_twist(int n, const RodMaterial& m, double R) {
  const double expected = 2.0 * kPi * std::sqrt(3.0) * m.EI / m.GJ;
  return critical_load(0.3 * expected, 2.0 * expected, [&](double angle) { return ring_is_stable(n, angle, m, R); });
}

/// `m` bent to a ring of radius R [m].
void list_ring(ProblemList& list, const char* label, const RodMaterial& m, double R, const char* what) {
  ValidationProblem p;
  p.name = std::string("michell-ring-").append(label);
  p.source = "Michell 1889, Zajac, J. Appl. Mech. 29:136, 1962: 2 pi sqrt(3) B/C";
  p.quantity = std::string("twist at which a flat ring writhes, ").append(what);
  p.unit = "rad";
  p.expected = 2.0 * kPi * std::sqrt(3.0) * m.EI / m.GJ;
  p.tolerance = 5e-3;
  p.least_order = 1.8;
  list.push_back({p, [m, R](ValidationProblem& r) {
                    r.got = critical_ring_twist(160, m, R);
                    r.order = observed_order(critical_ring_twist(40, m, R), critical_ring_twist(80, m, R), r.got);
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

/// A straight rod of `edges` between its ends, 1 m apart, under tension T, that can be twisted by a moment.
struct TwistedRod {
  TwistedRod(int edges, double T, bool clamped)
      : n(edges + (clamped ? 2 : 1)), edge(1.0 / edges), material(slender_rod(1.0, 0.7, 1.0, 1e4, 1.0)),
        state(RodState::from_nodes(nodes_on_x(n, 0.0, edge), n)), held(HeldCoordinates::Constant(4, n, false)) {
    state.rest_length /= 1.0 + T / material.EA;
    for (int i : {0, n - 1}) held.col(i).head<3>() = true;
    if (clamped)  // 1 m between the middles of the held edges
      for (int i : {1, n - 2}) held.col(i).head<3>() = true;
    held(3, 0) = held(3, n - 2) = true;
  }
  void twist(double M) {
    for (int j = 0; j + 1 < n; ++j) state.theta[j] = M / material.GJ * edge * j;
  }
  int n;
  double edge;
  RodMaterial material;
  RodState state;
  HeldCoordinates held;
};

double critical_moment_clamped(int edges, double T) {
  TwistedRod rod(edges, T, true);
  const double expected = greenhill_moment(T);
  return critical_load(0.3 * expected, 2.0 * expected, [&](double M) {
    rod.twist(M);
    return is_stable(rod.material, rod.state, rod.held);
  });
}

/// Where the determinant changes its sign; NaN if it is not known just above.
double critical_moment_pinned(int edges, double T) {
  TwistedRod rod(edges, T, false);
  const auto determinant = [&](double M) {
    rod.twist(M);
    return pinned_determinant(rod.material, rod.state, rod.held, M);
  };
  const double expected = 2.0 * std::sqrt(kPi * kPi + T);
  const double found = critical_load(0.3 * expected, 2.0 * expected, [&](double M) { return determinant(M) > 0.0; });
  return determinant(found * (1.0 + 1e-6)) < 0.0 ? found : kNaN;
}

void list_greenhill(ProblemList& list, double T, bool clamped) {
  ValidationProblem p;
  char text[120];
  std::snprintf(text, sizeof text, clamped ? "greenhill-%g" : "greenhill-pinned-%g", T);
  p.name = text;
  p.source = clamped ? "Greenhill 1883, B w'''' - i M w''' - T w'' = 0, both ends clamped (without tension tan x = x, M L/B = 2 x = 8.987)"
                     : "Greenhill 1883, ends pinned, moments along the axis: M = 2 B sqrt(pi^2/L^2 + T/B)";
  std::snprintf(text, sizeof text, "M L/B at which a straight rod turns into a helix, ends %s, T L^2/B = %g", clamped ? "clamped" : "pinned", T);
  p.quantity = text;
  p.expected = clamped ? greenhill_moment(T) : 2.0 * std::sqrt(kPi * kPi + T);
  p.tolerance = 5e-3;
  p.least_order = 1.8;
  list.push_back({p, [T, clamped](ValidationProblem& r) {
                    const auto critical = clamped ? critical_moment_clamped : critical_moment_pinned;
                    r.got = critical(320, T);
                    r.order = observed_order(critical(80, T), critical(160, T), r.got);
                  }});
}

}  // namespace

void list_twist(ProblemList& list) {
  list_uniform_twist(list);
  const auto rod = [](double C) { return slender_rod(1.0, C, 2.0 * kPi, 2e3, 1.0); };
  list_ring(list, "2-3", rod(2.0 / 3.0), 1.0, "C/B = 2/3");
  list_ring(list, "1-1.3", rod(1.0 / 1.3), 1.0, "C/B = 1/1.3");
  list_ring(list, "1", rod(1.0), 1.0, "C/B = 1");
  list_ring(list, "10-0", RodMaterial(), 5e-3, "10-0 nylon at a radius of 5 mm (theory: of any radius)");
  for (const bool clamped : {true, false})
    for (double T : {0.0, 10.0, 100.0}) list_greenhill(list, T, clamped);
}

}  // namespace filum
