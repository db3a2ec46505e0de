#pragma once
// A made-up cut end to side: an ellipse in the plane z = 0, 1.4 mm long and 0.6 mm wide, heel at +y, out of a vessel along y, and above it the bevelled end of a
// stump that leans towards +y, its edge a little shorter and rounder.

#include <cmath>
#include <numbers>

#include "world/observation.h"

namespace filum::testing_shapes {

inline constexpr double kVesselRadius = 0.45e-3;

/// Point at `psi` from the heel (+y) towards +x, and the length of the ellipse up to there.
inline Vec3 on_ellipse(double a, double b, double psi, double z) { return {b * std::sin(psi), a * std::cos(psi), z}; }

inline std::vector<Vec3> ellipse(double a, double b, double z, int n) {
  std::vector<Vec3> rim;
  for (int k = 0; k < n; ++k) rim.push_back(on_ellipse(a, b, 2.0 * std::numbers::pi * k / n, z));
  return rim;
}

inline TissueDescription oblique_edges() {
  TissueDescription t;
  t.kind = "vessel";
  t.lumen = true;
  t.cut_along = Vec3::UnitY();
  t.radius = kVesselRadius;
  t.thickness = 0.1e-3;
  t.edges[0] = {ellipse(0.7e-3, 0.3e-3, 0.0, 400), Vec3::UnitY(), Vec3(0, 0, -kVesselRadius)};
  t.edges[1] = {ellipse(0.6e-3, 0.4e-3, 0.3e-3, 400), Vec3(0, -std::sqrt(0.5), -std::sqrt(0.5)), Vec3(0, 0, 0.3e-3)};
  return t;
}

}  // namespace filum::testing_shapes
