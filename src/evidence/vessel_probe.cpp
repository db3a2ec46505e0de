#include "evidence/vessel_probe.h"

#include <numbers>

namespace filum {

constexpr double kDegree = std::numbers::pi / 180.0;

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

}  // namespace filum
