#include "evidence/rod_probe.h"

#include <cmath>
#include <numbers>

namespace filum {

RodMaterial slender_rod(double EI, double GJ, double length, double thinness, double mass_per_length) {
  RodMaterial m;
  m.radius = length / thinness;
  m.EI = EI;
  m.GJ = GJ;
  m.EA = 4.0 * EI / (m.radius * m.radius);  // of a round section
  m.density = mass_per_length / (std::numbers::pi * m.radius * m.radius);
  m.drag = 0.0;
  return m;
}

Points nodes_on_x(int n, double from, double edge) {
  Points p = Points::Zero(3, n);
  for (int i = 0; i < n; ++i) p(0, i) = from + edge * i;
  return p;
}

RodProbe::RodProbe(const RodMaterial& material, const Points& nodes)
    : rod(material, ContactMaterial(), static_cast<int>(nodes.cols())),
      state(RodState::from_nodes(nodes, static_cast<int>(nodes.cols()))),
      memory(rod.make_memory()) {
  rod.self_contact = false;
  options.gravity.setZero();
  options.max_iterations = 60;
  options.relative_tolerance = 1e-10;
  options.force_tolerance = 1e-13;
}

void RodProbe::hold_position(int i) {
  rod.boundary.held.col(i).head<3>() = true;
  rod.boundary.target.col(i).head<3>() = state.x.col(i);
}

void RodProbe::hold_angle(int j) {
  rod.boundary.held(3, j) = true;
  rod.boundary.target(3, j) = state.theta[j];
}

void RodProbe::hold(int i) {
  hold_position(i);
  hold_angle(i);
}

bool RodProbe::come_to_rest(double step_seconds, int most_steps, double still) {
  options.dt = step_seconds;
  for (int k = 0; k < most_steps; ++k) {
    const Points before = state.x;
    state.v.setZero();
    state.theta_dot.setZero();
    const RodStepSummary summary = rod.step(state, memory, options);
    if (!summary.sound) return false;
    if ((state.x - before).cwiseAbs().maxCoeff() < still && summary.arrived) return true;
  }
  return false;
}

double RodProbe::moment_at(int i) const {
  const double length = 0.5 * (state.rest_length[i - 1] + state.rest_length[i]);
  const double twist = state.theta[i] - state.theta[i - 1] + state.ref_twist[i];
  return rod.material.GJ * (twist - state.rest_twist[i]) / length;
}

double observed_order(double coarse, double middle, double fine) {
  return std::log2(std::abs((coarse - middle) / (middle - fine)));
}

double order_of_errors(double coarse, double fine, double ratio) { return std::log(std::abs(coarse / fine)) / std::log(ratio); }

}  // namespace filum
