#include "evidence/localized_helix.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "base/numbers.h"
#include "evidence/problem_list.h"

namespace filum {
namespace {

LocalizedHelix helix_of(const HelixRod& rod, double m) {
  const double root = rod.shortening / (4.0 * std::sqrt(1.0 - 0.25 * m * m));  // sqrt(B/T)
  const double cosine = 0.5 * m * m - 1.0;
  LocalizedHelix h;
  h.tension = rod.B / (root * root);
  h.moment = m * rod.B / root;
  h.angle = std::acos(cosine);
  h.width = 2.0 * rod.B / h.moment * std::sqrt((1.0 + cosine) / (1.0 - cosine));
  return h;
}

/// A nearly straight rod between two clamped edges.
RodProbe straight_rod(const HelixRod& rod, int edges) {
  const int n = edges + 2;
  const double edge = rod.length / edges;
  RodProbe probe(slender_rod(rod.B, rod.C, rod.length, 1e4, 1.0), nodes_on_x(n, -0.5 * edge, edge));
  Points nodes = probe.state.x;
  for (int i = 2; i < n - 2; ++i) nodes.col(i) += 1e-5 * rod.length * Vec3(0, 1, 1) * std::sin(kPi * nodes(0, i) / rod.length);
  const Eigen::VectorXd rest = probe.state.rest_length;
  probe.state = RodState::from_nodes(nodes, n);
  probe.state.rest_length = rest;
  for (int i : {0, 1, n - 2, n - 1}) probe.hold_position(i);
  for (int j : {0, n - 2}) probe.hold_angle(j);
  return probe;
}

/// Brings the ends together in the first quarter of the way and turns the last all the while. True if it then rests.
bool wind(RodProbe& probe, const HelixRod& rod) {
  constexpr int kParts = 60;
  const int n = probe.state.n;
  const Points start = probe.state.x;
  bool rests = false;
  probe.options.relative_tolerance = 1e-6;
  for (int k = 1; k <= kParts; ++k) {
    const double part = static_cast<double>(k) / kParts, come = rod.shortening * std::min(1.0, 4.0 * part);
    for (int i : {n - 2, n - 1}) probe.rod.boundary.target(0, i) = start(0, i) - come;
    probe.rod.boundary.target(3, n - 2) = 2.0 * kPi * rod.turns * part;
    rests = probe.come_to_rest(1e3, k == kParts ? 300 : 2, 1e-8 * rod.length);
  }
  return rests;
}

/// cos phi of each edge between the clamps, and the arc length of its middle.
struct Envelope {
  explicit Envelope(const RodState& s) {
    double arc = 0.0;
    for (int j = 1; j + 2 < s.n; ++j) {
      cosine.push_back((s.x(0, j + 1) - s.x(0, j)) / (s.x.col(j + 1) - s.x.col(j)).norm());
      at.push_back(arc + 0.5 * s.rest_length[j]);
      arc += s.rest_length[j];
    }
    const auto lowest = static_cast<std::size_t>(std::min_element(cosine.begin() + 1, cosine.end() - 1) - cosine.begin());
    const double a = cosine[lowest - 1], b = cosine[lowest], c = cosine[lowest + 1];  // a parabola through the lowest three
    least = b - 0.125 * (a - c) * (a - c) / (a - 2.0 * b + c);
    const double level = least + (1.0 - least) * std::pow(std::tanh(1.0), 2);
    std::size_t from = lowest, to = lowest;
    while (from > 0 && cosine[from - 1] < level) --from;
    while (to + 1 < cosine.size() && cosine[to + 1] < level) ++to;
    if (from == 0 || to + 1 == cosine.size()) return;
    const auto crossing = [&](std::size_t in, std::size_t out) { return at[in] + (at[out] - at[in]) * (level - cosine[in]) / (cosine[out] - cosine[in]); };
    width = 0.5 * (crossing(to, to + 1) - crossing(from, from - 1));
    middle = 0.5 * (crossing(to, to + 1) + crossing(from, from - 1));
  }
  std::vector<double> cosine, at;  // [1], [m]
  double least = kNaN, width = kNaN, middle = kNaN;
};

}  // namespace

LocalizedHelix localized_helix_theory(const HelixRod& rod) {
  const auto excess = [&](double m) { return helix_of(rod, m).moment * rod.length / rod.C + 4.0 * std::acos(0.5 * m) - 2.0 * kPi * rod.turns; };
  double low = std::sqrt(2.0), high = 2.0 - 1e-12;  // phi_0 from 90 degrees to 0
  for (int k = 0; k < 100; ++k) {
    const double middle = 0.5 * (low + high);
    (excess(low) * excess(middle) > 0.0 ? low : high) = middle;
  }
  return helix_of(rod, low);
}

HelixFound localized_helix_found(const HelixRod& rod, int edges) {
  RodProbe probe = straight_rod(rod, edges);
  if (!wind(probe, rod)) return {{kNaN, kNaN, kNaN, kNaN}, kNaN};
  const LocalizedHelix theory = localized_helix_theory(rod);
  const Envelope envelope(probe.state);
  HelixFound found;
  const Vec3 tail = (probe.state.x.col(2) - probe.state.x.col(1)).normalized();
  found.helix = {probe.moment_at(probe.state.n / 2), edge_tension(probe.rod.material, probe.state, 1) * tail.x(), std::acos(envelope.least), envelope.width};
  double sum = 0.0;
  for (std::size_t j = 0; j < envelope.at.size(); ++j) {
    const double got = (envelope.cosine[j] - std::cos(theory.angle)) / (1.0 - std::cos(theory.angle));
    sum += std::pow(got - std::pow(std::tanh((envelope.at[j] - envelope.middle) / theory.width), 2), 2);
  }
  found.envelope_error = std::sqrt(sum / static_cast<double>(envelope.at.size()));
  return found;
}

namespace {

/// Solved once for all that is asked of it.
const HelixFound& solved_helix(const HelixRod& rod, int edges) {
  static std::map<std::pair<double, int>, HelixFound> solved;
  const std::pair key(rod.length, edges);
  const auto found = solved.find(key);
  return found != solved.end() ? found->second : solved.emplace(key, localized_helix_found(rod, edges)).first->second;
}

struct HelixCase {
  const char *label, *what;
  HelixRod rod;
  int edges;  // the finer of two resolutions
};

struct HelixMeasure {
  const char *label, *quantity, *unit;
  double LocalizedHelix::*of;
  double scale;  // from SI to the unit
};

void list_helix(ProblemList& list, const HelixCase& c, const HelixMeasure& m) {
  ValidationProblem p;
  p.name = std::string("localized-helix-") + c.label + "-" + m.label;
  p.source = std::string("van der Heijden & Thompson, Nonlinear Dyn. 21:71, 2000, infinite rod; ") + c.what;
  p.quantity = m.quantity;
  p.unit = m.unit;
  p.expected = m.scale * localized_helix_theory(c.rod).*m.of;
  p.tolerance = 1e-2;
  p.least_order = 1.8;
  list.push_back({p, [c, m](ValidationProblem& r) {
                    const auto at = [&](int edges) { return m.scale * solved_helix(c.rod, edges).helix.*m.of; };
                    r.got = at(c.edges);
                    r.order = order_of_errors(at(c.edges / 2) - r.expected, r.got - r.expected);
                  }});
}

void list_envelope(ProblemList& list, const HelixCase& c) {
  ValidationProblem p;
  p.name = std::string("localized-helix-") + c.label + "-envelope";
  p.source = std::string("the same, tanh^2(s/s*); ") + c.what;
  p.quantity = "root mean square deviation of the envelope of the angles along the rod";
  p.tolerance = 2e-3;
  p.least_order = 1.8;
  list.push_back({p, [c](ValidationProblem& r) {
                    r.got = solved_helix(c.rod, c.edges).envelope_error;
                    r.order = order_of_errors(solved_helix(c.rod, c.edges / 2).envelope_error, r.got);
                  }});
}

/// As others report it, with so many edges.
void list_peers_envelope(ProblemList& list, const HelixCase& c, int edges) {
  ValidationProblem p;
  p.name = std::string("localized-helix-") + c.label + "-envelope-" + std::to_string(edges);
  p.source = std::string("the same, tanh^2(s/s*); ") + c.what;
  p.quantity = "norm of the envelope's deviations over their number, " + std::to_string(edges) + " edges";
  p.tolerance = 2e-3;
  p.note = "no order: one mesh, to stand beside what others report for it (a discrete elastic rod in MuJoCo 1.89e-3, MuJoCo's own cable 3.48e-3; that theirs is this norm is inferred)";
  list.push_back({p, [c, edges](ValidationProblem& r) { r.got = solved_helix(c.rod, edges).envelope_error / std::sqrt(edges); }});
}

}  // namespace

void list_localized_helix(ProblemList& list) {
  const HelixCase cases[] = {{"long", "B 1.345, C 0.789 N m2, 100 m, 27 turns, 3 m shorter", {1.345, 0.789, 100.0, 27.0, 3.0}, 800},
                             {"short", "the rod of Bergou et al., ACM TOG 27(3):63, 2008: 9.29 m, 27 turns, 0.3 m shorter", {1.345, 0.789, 9.29, 27.0, 0.3}, 800}};
  const HelixMeasure measures[] = {{"moment", "twisting moment", "N m", &LocalizedHelix::moment, 1.0},
                                   {"tension", "tension", "N", &LocalizedHelix::tension, 1.0},
                                   {"angle", "largest angle between rod and axis", "deg", &LocalizedHelix::angle, 180.0 / kPi},
                                   {"width", "half width s* of the envelope", "m", &LocalizedHelix::width, 1.0}};
  for (const HelixCase& c : cases) {
    for (const HelixMeasure& m : measures) list_helix(list, c, m);
    list_envelope(list, c);
  }
  list_peers_envelope(list, cases[1], 180);
}

}  // namespace filum
