#include "evidence/vessel_probe.h"

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

/// What an element has more around than through the wall [Pa], in the middle of its inner or outer face.
double shear_at(const WallElements& elements, const SliceState& state, int e, bool inner) {
  Vec3 middle = Vec3::Zero();
  for (const int node : state.mesh.elements[static_cast<std::size_t>(e)]) middle += state.x.col(node) / 8.0;
  const Vec3 through = Vec3(middle.x(), middle.y(), 0.0).normalized(), around = Vec3::UnitZ().cross(through);
  const Mat3 stress = elements.stress(e, Vec3(0.0, 0.0, inner ? -1.0 : 1.0), state.x);
  return around.dot(stress * around) - through.dot(stress * through);
}

}  // namespace

SurfaceStress surface_stress(const TubeSlice& slice, const SliceState& state, double pressure) {
  if (!state.converged) return {};
  const WallElements elements(state.mesh, slice.layers);
  SurfaceStress found;
  for (int e = 0; e < state.mesh.n_elements(); ++e) {
    const auto& span = state.mesh.span[static_cast<std::size_t>(e)];
    if (span[0] < 1e-9) found.inner = shear_at(elements, state, e, true) - pressure;
    if (span[1] > 1.0 - 1e-9) found.outer = shear_at(elements, state, e, false);
  }
  return found;
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
