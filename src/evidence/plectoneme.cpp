#include "evidence/plectoneme.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "base/numbers.h"
#include "evidence/linking.h"
#include "evidence/percentile.h"
#include "evidence/problem_list.h"

namespace filum {
namespace {

constexpr double kLength = 0.5, kRadius = 1.55e-3, kSlack = 0.3;  // [m], [m], [-]
constexpr double kTurns = 8.0;
constexpr int kLookEvery = 50;  // steps, at the linking number

/// The rod of dismech-newton's plectoneme, 1.3 MPa; a hundredth of its weight, so that it comes to rest soon.
RodMaterial ply_material() {
  RodMaterial m = RodMaterial::round_wire(kRadius, 1.3e6, 0.5, 12.0);
  m.drag = 4e-3;
  m.internal_friction = 5e-3;
  return m;
}

Points nearly_straight(int n, double edge) {
  Points x = nodes_on_x(n, -0.5 * edge, edge);
  for (int i = 2; i < n - 2; ++i) x.col(i) += Vec3(0, 1e-3, 0.5e-3) * std::sin(kPi * x(0, i) / kLength);
  return x;
}

}  // namespace

double ply_tension(double a) { return std::pow(std::sin(a), 3) * (std::cos(a) * std::tan(2.0 * a) - 0.5 * std::sin(a)); }

double ply_moment(double a) { return 2.0 / std::sin(2.0 * a) * (0.5 * std::pow(std::sin(a), 4) + ply_tension(a)); }

Plectoneme::Plectoneme(int edges) : probe(ply_material(), nearly_straight(edges + 2, kLength / edges)) {
  const int n = probe.state.n;
  probe.rod.self_contact = true;
  probe.rod.contact_material.stiffness = 5e3;
  probe.rod.contact_material.friction = 0.0;
  probe.options = RodStepOptions();
  probe.options.gravity.setZero();
  probe.options.force_tolerance = 1e-6;
  for (int i : {0, 1, n - 2, n - 1}) probe.hold_position(i);
  for (int j : {0, n - 2}) probe.hold_angle(j);
}

bool Plectoneme::run(int steps, double come, double turn) {
  const int n = probe.state.n;
  for (int k = 0; k < steps; ++k) {
    for (int i : {n - 2, n - 1}) probe.rod.boundary.target(0, i) -= come / steps;
    probe.rod.boundary.target(3, n - 2) += turn / steps;
    if (!probe.rod.step(probe.state, probe.memory, probe.options).sound) return false;
    turned_ += turn / (2.0 * kPi * steps);
    if (k % kLookEvery == 0) farthest_ = std::max(farthest_, std::abs(linking() - turned_));
  }
  return true;
}

bool Plectoneme::wind(double turns) {
  const double all = 2.0 * kPi * turns;
  if (!run(500, kSlack * kLength, 0.1 * all) || !run(3000, 0.0, 0.9 * all) || !run(1500, 0.0, 0.0)) return false;
  return probe.state.v.leftCols(probe.state.n).cwiseAbs().maxCoeff() < 1e-3;
}

Ply Plectoneme::ply() const {
  const Points& x = probe.state.x;
  std::vector<double> radii, angles;
  std::vector<const RodPair*> touching;
  for (const RodPair& p : probe.rod.contact().pairs())
    if (p.force > 0.0) touching.push_back(&p);
  std::sort(touching.begin(), touching.end(), [](const RodPair* a, const RodPair* b) { return a->i < b->i; });
  for (std::size_t k = touching.size() / 4; k < touching.size() - touching.size() / 4; ++k) {
    const RodPair& p = *touching[k];
    radii.push_back(0.5 * p.distance);
    const Vec3 a = (x.col(p.i + 1) - x.col(p.i)).normalized(), b = (x.col(p.j + 1) - x.col(p.j)).normalized();
    angles.push_back(0.5 * std::acos(std::min(1.0, std::abs(a.dot(b)))));
  }
  return {median(radii), median(angles), static_cast<int>(touching.size())};
}

double Plectoneme::tension() const {
  const Vec3 t = (probe.state.x.col(2) - probe.state.x.col(1)).normalized();
  return edge_tension(probe.rod.material, probe.state, 1) * t.x();
}

double Plectoneme::moment() const { return probe.moment_at(2); }

/// The tails go on straight for a hundred lengths, where closing them adds nothing that counts.
double Plectoneme::linking() const {
  const RodState& s = probe.state;
  Points curve(3, s.n + 2);
  curve << s.x.col(0) - Vec3(100.0 * kLength, 0, 0), s.x.leftCols(s.n), s.x.col(s.n - 1) + Vec3(100.0 * kLength, 0, 0);
  double twist = 0.0;
  for (int i = 1; i + 1 < s.n; ++i) twist += s.theta[i] - s.theta[i - 1] + s.ref_twist[i];
  return twist / (2.0 * kPi) + writhe(curve);
}

namespace {

/// Solved once for all that is asked of it.
const Plectoneme* wound() {
  static Plectoneme p(300);
  static const bool rests = p.wind(kTurns);
  return rests ? &p : nullptr;
}

void list_measure(ProblemList& list, const char* name, const char* quantity, double tolerance, double (*measure)(const Plectoneme&)) {
  ValidationProblem p;
  p.name = std::string("plectoneme-") + name;
  p.source = "Clauvelin, Audoly & Neukirch, J. Mech. Phys. Solids 57:1565, 2009, at the ply's measured angle; 0.5 m, radius 1.55 mm, slack 30 %, 8 turns";
  p.quantity = quantity;
  p.expected = 1.0;
  p.tolerance = tolerance;
  p.note = "no order: medians over contacts, whose number and places change with the mesh; 300 edges";
  list.push_back({p, [measure](ValidationProblem& r) { r.got = wound() ? measure(*wound()) : std::nan(""); }});
}

}  // namespace

void list_plectoneme(ProblemList& list) {
  list_measure(list, "radius", "radius of the ply over that of the rod", 0.03, [](const Plectoneme& p) { return p.ply().radius / kRadius; });
  list_measure(list, "tension", "tension over theory", 0.03, [](const Plectoneme& p) {
    const Ply ply = p.ply();
    return p.tension() * ply.radius * ply.radius / (p.probe.rod.material.EI * ply_tension(ply.angle));
  });
  list_measure(list, "moment", "twisting moment over theory", 0.03, [](const Plectoneme& p) {
    const Ply ply = p.ply();
    return p.moment() * ply.radius / (p.probe.rod.material.EI * ply_moment(ply.angle));
  });
  list_measure(list, "linking", "twist and writhe over the turns given", 0.1 / kTurns, [](const Plectoneme& p) { return p.linking() / kTurns; });
  list_measure(list, "linking-always", "1 + largest difference, while it is wound, of twist and writhe from the turns given so far", 0.1,
               [](const Plectoneme& p) { return 1.0 + p.farthest(); });
}

}  // namespace filum
