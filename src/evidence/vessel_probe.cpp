#include "evidence/vessel_probe.h"

#include <cmath>
#include <cstdio>

#include "base/numbers.h"
#include "evidence/rod_probe.h"

namespace filum {

TubeSlice rabbit_carotid(bool opened) {
  TubeSlice s;
  s.shape.inner_radius = opened ? 1.43e-3 : 0.71e-3;
  s.shape.opening_angle = opened ? 160.0 * kDegree : 0.0;
  s.shape.thickness = 0.39e-3;
  s.shape.length = 0.1e-3;
  const auto layer = [](const char* name, double thickness, double c, double k1, double k2, double beta) {
    WallLaw law;
    law.kind = WallLaw::Kind::fibres;
    law.mu = c;
    law.lambda = 200e6;  // incompressible: stresses change volumes by less than a percent
    law.k1 = k1;
    law.k2 = k2;
    law.beta = beta * kDegree;
    return WallLayer{name, thickness, law};
  };
  s.layers = {layer("media", 0.26e-3, 3000.0, 2363.2, 0.8393, 29.0), layer("adventitia", 0.13e-3, 300.0, 562.0, 0.7112, 62.0)};
  return s;
}

namespace {

constexpr double kFace = 1.0 - 1e-6;  // zeta just inside a face: on one where layers meet rounding would choose between their laws

/// What an element has more around than through the wall [Pa], at zeta in its middle, -1 on its inner face.
double shear_at(const WallElements& elements, const SliceState& state, int e, double zeta) {
  Vec3 middle = Vec3::Zero();
  for (const int node : state.mesh.elements[static_cast<std::size_t>(e)]) middle += state.x.col(node) / 8.0;
  const Vec3 through = Vec3(middle.x(), middle.y(), 0.0).normalized(), around = Vec3::UnitZ().cross(through);
  const Mat3 stress = elements.stress(e, Vec3(0.0, 0.0, zeta), state.x);
  return around.dot(stress * around) - through.dot(stress * through);
}

/// Share of the wall's thickness, as elements span it, that the first layer fills.
double first_share(const TubeSlice& slice) { return slice.layers.front().thickness / slice.shape.thickness; }
bool same(double a, double b) { return std::abs(a - b) < 1e-9; }

/// [m], of a corner of an element from the axis.
double radius_of(const SliceState& state, int e, std::size_t corner) {
  return state.x.col(state.mesh.elements[static_cast<std::size_t>(e)][corner]).head<2>().norm();
}

}  // namespace

SurfaceStress surface_stress(const TubeSlice& slice, const SliceState& state, double pressure) {
  if (!state.converged) return {};
  const WallElements elements(state.mesh, slice.layers);
  const double share = first_share(slice);
  SurfaceStress found;
  double radial = 0.0;  // [Pa], where the first layer ends
  for (int e = 0; e < state.mesh.n_elements(); ++e) {
    const auto& span = state.mesh.span[static_cast<std::size_t>(e)];
    if (same(span[0], 0.0)) found.inner = shear_at(elements, state, e, -kFace) - pressure;
    if (same(span[1], 1.0)) found.outer = shear_at(elements, state, e, kFace);
    if (slice.layers.size() != 2) continue;
    if (same(span[1], share)) found.media = shear_at(elements, state, e, kFace);
    if (same(span[0], share)) found.adventitia = shear_at(elements, state, e, -kFace);
    if (span[0] > share - 1e-9) radial -= shear_at(elements, state, e, 0.0) * std::log(radius_of(state, e, 4) / radius_of(state, e, 0)) / slice.around;
  }
  found.media += radial;
  found.adventitia += radial;
  return found;
}

double interface_radius(const TubeSlice& slice, const SliceState& state) {
  for (int e = 0; state.converged && e < state.mesh.n_elements(); ++e)
    if (same(state.mesh.span[static_cast<std::size_t>(e)][0], first_share(slice))) return radius_of(state, e, 0);
  return kNaN;
}

double surface_stretch(const SliceState& state, bool inner) {
  const std::size_t a = inner ? 0 : 4;
  for (int e = 0; state.converged && e < state.mesh.n_elements(); ++e) {
    const auto index = static_cast<std::size_t>(e);
    if (!same(state.mesh.span[index][inner ? 0 : 1], inner ? 0.0 : 1.0)) continue;
    const auto& nodes = state.mesh.elements[index];
    const Corners& free = state.mesh.stress_free[index];
    return (state.x.col(nodes[a + 1]) - state.x.col(nodes[a])).norm() / (free.col(static_cast<int>(a) + 1) - free.col(static_cast<int>(a))).norm();
  }
  return kNaN;
}

void follow_first_order(ValidationProblem& r, const std::array<double, 3>& coarse_to_fine) {
  const auto& [coarse, middle, fine] = coarse_to_fine;
  r.got = 2.0 * fine - middle;
  r.order = observed_order(coarse, middle, fine);
  char at_finest[60];
  std::snprintf(at_finest, sizeof at_finest, " (%.4g at the finest)", fine);
  r.quantity += at_finest;
}

}  // namespace filum
