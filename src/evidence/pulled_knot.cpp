#include "evidence/pulled_knot.h"

#include <vector>

namespace filum {
namespace {

RodMaterial knot_material() {
  RodMaterial m = RodMaterial::round_wire(1.6e-3, 0.18e6, 0.5, 1180.0);
  m.drag = 1e-3;
  return m;
}

}  // namespace

Points overhand_curve(int n, double length) {
  constexpr int kFine = 4000;
  std::vector<Vec3> curve;
  std::vector<double> arc{0.0};
  for (int k = 0; k <= kFine; ++k) {
    const double t = -2.3 + 4.6 * k / kFine, t2 = t * t;
    curve.emplace_back(t * (t2 - 3.0), t2 * (t2 - 4.0), 0.2 * t * (t2 * t2 - 10.0));
    if (k > 0) arc.push_back(arc.back() + (curve[k] - curve[k - 1]).norm());
  }
  Points p(3, n);
  double total = 0.0;
  for (int i = 0, k = 0; i < n; ++i) {
    const double s = arc.back() * i / (n - 1);
    while (k + 2 < static_cast<int>(curve.size()) && arc[k + 1] < s) ++k;
    p.col(i) = curve[k] + (curve[k + 1] - curve[k]) * ((s - arc[k]) / (arc[k + 1] - arc[k]));
    if (i > 0) total += (p.col(i) - p.col(i - 1)).norm();
  }
  return p * (length / total);
}

PulledKnot::PulledKnot(int n, double friction, double dt) : probe(knot_material(), overhand_curve(n, 1.0)) {
  probe.rod.self_contact = true;
  probe.rod.contact_material.stiffness = 200.0;
  probe.rod.contact_material.friction = friction;
  probe.rod.contact_material.presliding = 0.05 * probe.rod.material.radius;
  probe.options = RodStepOptions();
  probe.options.dt = dt;
  probe.options.gravity.setZero();
  probe.options.force_tolerance = 1e-6;
  for (int i : {0, 1, n - 2, n - 1}) probe.hold(i);
  direction = (probe.state.x.col(n - 1) - probe.state.x.col(0)).normalized();
}

RodStepSummary PulledKnot::pull(double speed) {
  const int n = probe.state.n;
  const Vec3 step = speed * probe.options.dt * direction;
  for (int i : {0, 1}) probe.rod.boundary.target.col(i).head<3>() -= step;
  for (int i : {n - 2, n - 1}) probe.rod.boundary.target.col(i).head<3>() += step;
  return probe.rod.step(probe.state, probe.memory, probe.options);
}

double PulledKnot::shortening() const {
  const int n = probe.state.n;
  return probe.state.rest_length.head(n - 1).sum() - (probe.state.x.col(n - 1) - probe.state.x.col(0)).norm();
}

double PulledKnot::tension() const {
  return edge_tension(probe.rod.material, probe.state, 2);
}

}  // namespace filum
