#include "evidence/drawn_knot.h"

namespace filum {

DrawnKnot::DrawnKnot(const RodMaterial& material, const Points& curve, double friction, double dt) : probe(material, curve) {
  const int n = probe.state.n;
  probe.rod.self_contact = true;
  probe.rod.contact_material.stiffness = 200.0;
  probe.rod.contact_material.friction = friction;
  probe.rod.contact_material.presliding = 0.05 * material.radius;
  probe.options = RodStepOptions();
  probe.options.dt = dt;
  probe.options.gravity.setZero();
  probe.options.force_tolerance = 1e-6;
  for (int i : {0, 1, n - 2, n - 1}) probe.hold(i);
  direction = (probe.state.x.col(n - 1) - probe.state.x.col(0)).normalized();
}

RodStepSummary DrawnKnot::pull(double speed) {
  const int n = probe.state.n;
  const Vec3 step = speed * probe.options.dt * direction;
  for (int i : {0, 1}) probe.rod.boundary.target.col(i).head<3>() -= step;
  for (int i : {n - 2, n - 1}) probe.rod.boundary.target.col(i).head<3>() += step;
  return probe.rod.step(probe.state, probe.memory, probe.options);
}

double DrawnKnot::shortening() const {
  const int n = probe.state.n;
  return probe.state.rest_length.head(n - 1).sum() - (probe.state.x.col(n - 1) - probe.state.x.col(0)).norm();
}

double DrawnKnot::tension() const { return edge_tension(probe.rod.material, probe.state, 2); }

}  // namespace filum
