#include "physics/hyperelastic.h"

#include <algorithm>
#include <cmath>

namespace filum {
namespace {
constexpr double kBell = 0.15;  // [-], half width of the bell of stretch at 1/e
}

WallLaw WallLaw::hooke(double young, double poisson) {
  WallLaw law;
  law.kind = Kind::linear;
  law.mu = young / (2.0 * (1.0 + poisson));
  law.lambda = 2.0 * law.mu * poisson / (1.0 - 2.0 * poisson);
  return law;
}

double MuscleTone::share(double l) const noexcept {
  if (l <= 1.0) return 0.0;
  if (shape == Shape::parabola) return std::max(0.0, 1.0 - std::pow((best - l) / (best - 1.0), 2));
  const auto bell = [&](double at) { return std::exp(-std::pow((at - best) / kBell, 2)); };
  return std::max(0.0, bell(l) - bell(1.0));  // none in the vessel without load
}

double MuscleTone::end() const noexcept { return 2.0 * best - 1.0; }

LawConstants::LawConstants(const WallLaw& law)
    : kind(law.kind), mu(law.mu), lambda(law.lambda_point()), k1(law.k1), k2(law.k2), strain_end(std::sqrt(kLargestExponent / law.k2)), c20(law.c20), growth(law.growth) {
  slope_end = k1 * (1.0 + 2.0 * kLargestExponent) * std::exp(kLargestExponent);
  growth_end = growth > 0.0 ? kLargestExponent / growth : 0.0;
  growth_slope = 0.5 * mu * growth * std::exp(kLargestExponent);
  if (law.tone.stress <= 0.0) return;
  constexpr int kParts = 500;
  tone_step = (law.tone.end() * law.tone.end() - 1.0) / kParts;
  double sum = 0.0;
  for (int k = 0; k <= kParts; ++k) {  // l dPsi/dl = 2 I dPsi/dI
    const double I = 1.0 + k * tone_step, slope = 0.5 * law.tone.stress * law.tone.share(std::sqrt(I)) / I;
    if (k > 0) sum += 0.5 * tone_step * (tone_slope.back() + slope);
    tone_slope.push_back(slope);
    tone_energy.push_back(sum);
  }
}

double tone_energy(const LawConstants& c, double e, double& slope, double* bend) noexcept {
  slope = 0.0;
  if (bend != nullptr) *bend = 0.0;
  const double x = e / c.tone_step;
  if (!(x > 0.0)) return 0.0;
  if (x >= static_cast<double>(c.tone_slope.size() - 1)) return c.tone_energy.back();
  const auto k = static_cast<std::size_t>(x);
  const double t = x - static_cast<double>(k), a = c.tone_slope[k], b = c.tone_slope[k + 1];
  slope = a + t * (b - a);
  if (bend != nullptr) *bend = (b - a) / c.tone_step;
  return c.tone_energy[k] + 0.5 * (a + slope) * t * c.tone_step;
}

SixSix volume_ratio_tangent(const LawGeometry<double>& g, const Six& C) noexcept {
  Six dJ;
  const double J = volume_ratio(g, C.data(), dJ.data());
  const double scale = 0.5 * g.inverse_root * g.inverse_root / J;
  SixSix D = SixSix::Zero();  // of det C
  D(0, 1) = C[2];
  D(0, 2) = C[1];
  D(1, 2) = C[0];
  D(0, 4) = -2.0 * C[4];
  D(1, 5) = -2.0 * C[5];
  D(2, 3) = -2.0 * C[3];
  D(3, 3) = -2.0 * C[2];
  D(4, 4) = -2.0 * C[0];
  D(5, 5) = -2.0 * C[1];
  D(3, 4) = 2.0 * C[5];
  D(3, 5) = 2.0 * C[4];
  D(4, 5) = 2.0 * C[3];
  D.triangularView<Eigen::StrictlyLower>() = D.transpose();
  return scale * D - dJ * dJ.transpose() / J;
}

SixSix law_tangent(const LawConstants& c, const LawGeometry<double>& g, const Six& C, bool taut) noexcept {
  SixSix D = SixSix::Zero();
  if (c.kind == WallLaw::Kind::linear) {  // the derivative is linear in C: its columns are those of the unit vectors
    Six at_zero, zero = Six::Zero();
    green_energy(c, g, zero.data(), at_zero.data());
    for (int n = 0; n < 6; ++n) {
      const Six unit = Six::Unit(n);
      Six T;
      green_energy(c, g, unit.data(), T.data());
      D.col(n) = T - at_zero;
    }
    return D;
  }
  Six dJ;
  const double J = volume_ratio(g, C.data(), dJ.data());
  const double i2 = 1.0 / (J * J), volume = 0.25 * (c.lambda + c.mu);
  D = volume * ((1.0 + i2) * (1.0 + i2) - 2.0 * (1.0 - i2) * i2) * dJ * dJ.transpose();
  D += (volume * (J - 1.0 / J) * (1.0 + i2) - c.mu) * volume_ratio_tangent(g, C);
  if (c.c20 > 0.0 || c.growth > 0.0) {
    Six s;
    for (int m = 0; m < 6; ++m) s[m] = (m < 3 ? 1.0 : 2.0) * g.metric[m];
    const double e = first_invariant(g, C.data()) - 3.0;
    const double rise = c.growth <= 0.0 ? 0.0 : e < c.growth_end ? 0.5 * c.mu * c.growth * std::exp(c.growth * e) : c.growth_slope;
    D += (2.0 * c.c20 + rise) * s * s.transpose();
  }
  if (!c.tone_slope.empty()) {
    const double way = around(g);
    double slope = 0.0, bend = 0.0;
    tone_energy(c, way * C[0] - 1.0, slope, &bend);
    D(0, 0) += bend * way * way;
  }
  if (c.kind != WallLaw::Kind::fibres) return D;
  for (const auto& a : g.fibre) {
    const double stretched = a[0] * C[0] + a[1] * C[1] + a[2] * C[3] - 1.0;
    if (stretched <= 0.0 && !taut) continue;
    const double e = std::max(stretched, 0.0);
    const double bend = e < c.strain_end ? c.k1 * (1.0 + 2.0 * c.k2 * e * e) * std::exp(c.k2 * e * e) : c.slope_end;
    Six s = Six::Zero();
    s[0] = a[0];
    s[1] = a[1];
    s[3] = a[2];
    D += bend * s * s.transpose();
  }
  return D;
}

}  // namespace filum
