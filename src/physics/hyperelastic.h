#pragma once
// Laws of the vessel wall: energy per stress-free volume as a function of the right Cauchy-Green tensor C, whose components are
// given in any (oblique) basis of the stress-free body: C_ij = g_i . g_j with g_i the deformed basis vectors, and everything
// that depends on the stress-free shape alone is in LawGeometry. Components in the order 11, 22, 33, 12, 23, 13; derivatives are
// with respect to these six numbers, so those of 12, 23, 13 hold both halves of the symmetric tensor.
//
//   linear       Psi = mu E:E + (l/2) (tr E)^2,  E = (C - I)/2           (Saint Venant-Kirchhoff; Hooke's law at small strain)
//   neo-Hookean  Psi = (mu/2)(I1 - 3) - mu (J - 1) + ((l + mu)/8)(J - 1/J)^2
//   fibres       neo-Hookean + sum over two families of (k1/2 k2) [exp(k2 (I_i - 1)^2) - 1] where I_i > 1, I_i = a_i . C a_i
//                (Holzapfel, Gasser & Ogden, J. Elasticity 61:1, 2000, eq. 62-65; invariants not split off their volume part:
//                Sansour, Eur. J. Mech. A 27:28, 2008). mu is their c.
// Beside neo-Hookean and fibres, each where its number is not zero:
//   c20          c20 (I1 - 3)^2                                  (Yeoh, Rubber Chem. Technol. 66:754, 1993, its first two terms)
//   growth b     (mu/2) [(exp(b (I1 - 3)) - 1)/b - (I1 - 3)]     (Demiray, J. Biomech. 5:309, 1972: with mu's part (mu/2b)(exp(b (I1 - 3)) - 1))
//   tone         dPsi = S f(l) dl/l, l the stretch along the first direction (around a vessel): Cauchy stress S f(l) of smooth muscle,
//                f a parabola from 0 where l = 1 to 1 where it is best (Rachev & Hayashi, Ann. Biomed. Eng. 27:459, 1999), or a bell
// The terms in J have at J = 1 the stress and the stiffness of mu ln J and (l/2)(J - 1)^2; the last grows without bound as a point is
// squashed. `l` here is the point's share of Lame's constant (see vessel_wall_element.h); what resists the change of an
// element's whole volume is added there. Exponents above kLargestExponent are continued by a straight line of stress.
// Neglects: fibre dispersion, viscoelasticity; tone's time course. Test: hyperelastic_test.

#include <Eigen/Core>
#include <string>
#include <vector>

#include "physics/vessel_wall_lanes.h"

namespace filum {

/// Active stress of smooth muscle around a vessel, as a function of its stretch.
struct MuscleTone {
  enum class Shape { parabola, bell };
  Shape shape = Shape::parabola;
  double stress = 0.0;  // [Pa], Cauchy, the most; 0: none
  double best = 1.3;    // [-], stretch at which it has it, above 1
  /// Share of the stress at stretch l; none at 1 and below.
  double share(double l) const noexcept;
  /// Stretch from which on there is none again.
  double end() const noexcept;
};

struct WallLaw {
  enum class Kind { linear, neo_hookean, fibres };
  Kind kind = Kind::linear;
  double mu = 0.0;      // [Pa], shear modulus
  double lambda = 0.0;  // [Pa], Lame's second constant
  double k1 = 0.0;      // [Pa], fibres
  double k2 = 1.0;      // [-]
  double beta = 0.0;    // [rad], angle of the fibres +- to the circumference
  double c20 = 0.0;     // [Pa], stiffening
  double growth = 0.0;  // [-], of the exponential
  MuscleTone tone;

  static WallLaw hooke(double young, double poisson);
  /// Lame's share that belongs to points, such that a plate of one element through its thickness bends as plane stress
  /// demands: 2 mu lambda / (lambda + 2 mu), which is 2 mu for an incompressible wall.
  double lambda_point() const noexcept { return 2.0 * mu * lambda / (lambda + 2.0 * mu); }
};

using Six = Eigen::Matrix<double, 6, 1>;
using SixSix = Eigen::Matrix<double, 6, 6>;

/// What the stress-free shape says at a point: contravariant metric, 1/sqrt(det of the covariant one), fibres' components
/// (a1 a1, a2 a2, 2 a1 a2) of both families in the tangent plane of the wall.
template <class S>
struct LawGeometry {
  S metric[6];
  S inverse_root;
  S fibre[2][3];
};

/// Numbers of a law worked out once.
struct LawConstants {
  explicit LawConstants(const WallLaw& law);
  WallLaw::Kind kind;
  double mu, lambda;         // [Pa], lambda of a point
  double k1, k2;
  double strain_end;         // I - 1 where the exponential ends
  double slope_end;          // d2Psi/dI2 [Pa] there and beyond
  double c20, growth;
  double growth_end, growth_slope;  // I1 - 3 where that exponential ends, d2Psi/dI1^2 [Pa] beyond
  std::vector<double> tone_slope, tone_energy;  // [Pa]: dPsi/dI and Psi at I - 1 = k tone_step, I = l^2; straight between; empty: no tone
  double tone_step = 1.0;
};
inline constexpr double kLargestExponent = 12.0;
inline constexpr double kTiny = 1e-12;  // least J^2: so that no number of a squashed element is infinite

template <class S>
S first_invariant(const LawGeometry<S>& g, const S* C) noexcept {
  const S* m = g.metric;
  return m[0] * C[0] + m[1] * C[1] + m[2] * C[2] + 2.0 * (m[3] * C[3] + m[4] * C[4] + m[5] * C[5]);
}

/// J = sqrt(det C / det G) and its derivatives.
template <class S>
S volume_ratio(const LawGeometry<S>& g, const S* C, S* dJ) noexcept {
  dJ[0] = C[1] * C[2] - C[4] * C[4];
  dJ[1] = C[0] * C[2] - C[5] * C[5];
  dJ[2] = C[0] * C[1] - C[3] * C[3];
  dJ[3] = 2.0 * (C[4] * C[5] - C[2] * C[3]);
  dJ[4] = 2.0 * (C[3] * C[5] - C[0] * C[4]);
  dJ[5] = 2.0 * (C[3] * C[4] - C[1] * C[5]);
  const S det = C[0] * dJ[0] + 0.5 * (C[3] * dJ[3] + C[5] * dJ[5]);
  const S root = root_of(positive_part(S(det * g.inverse_root * g.inverse_root - kTiny)) + kTiny);
  const S scale = 0.5 * g.inverse_root * g.inverse_root / root;
  for (int m = 0; m < 6; ++m) dJ[m] = dJ[m] * scale;
  return root;
}

/// Psi of one family at I - 1 = e and dPsi/dI.
template <class S>
S fibre_energy(const LawConstants& c, const S& e_all, S& slope) noexcept {
  const S e = positive_part(e_all);
  const S inside = least_of(e, S(c.strain_end));
  const S beyond = e - inside;
  const S power = exp_of(c.k2 * inside * inside);
  slope = c.k1 * inside * power + c.slope_end * beyond;
  return c.k1 / (2.0 * c.k2) * (power - 1.0) + c.k1 * inside * power * beyond + 0.5 * c.slope_end * beyond * beyond;
}

/// Psi of the isotropic stiffening at I1 - 3 = e and dPsi/dI1.
template <class S>
S stiffening_energy(const LawConstants& c, const S& e, S& slope) noexcept {
  slope = 2.0 * c.c20 * e;
  S energy = c.c20 * e * e;
  if (c.growth <= 0.0) return energy;
  const S inside = least_of(e, S(c.growth_end)), beyond = e - inside, rise = 0.5 * c.mu * (exp_of(c.growth * inside) - 1.0);
  slope = slope + rise + c.growth_slope * beyond;
  return energy + rise / c.growth - 0.5 * c.mu * inside + rise * beyond + 0.5 * c.growth_slope * beyond * beyond;
}

/// Psi of the tone at I - 1 = e and dPsi/dI, and where wanted d2Psi/dI2.
double tone_energy(const LawConstants& c, double e, double& slope, double* bend = nullptr) noexcept;
template <class N, int bytes>
Lanes<N, bytes> tone_energy(const LawConstants& c, const Lanes<N, bytes>& e, Lanes<N, bytes>& slope) noexcept {
  Lanes<N, bytes> energy;
  for (int k = 0; k < Lanes<N, bytes>::kWidth; ++k) {
    double own = 0.0;
    energy.set(k, tone_energy(c, static_cast<double>(e[k]), own));
    slope.set(k, own);
  }
  return energy;
}

/// 1/G_11: C_11 over the square of the first basis vector's length is the square of the stretch along it.
template <class S>
S around(const LawGeometry<S>& g) noexcept {
  return g.inverse_root * g.inverse_root / (g.metric[1] * g.metric[2] - g.metric[4] * g.metric[4]);
}

/// mu E:E of the linear law and its derivatives, which need C raised to both upper indices.
template <class S>
S green_energy(const LawConstants& c, const LawGeometry<S>& g, const S* C, S* T) noexcept {
  constexpr int at[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};
  S mixed[3][3], trace2 = S(0.0);  // G^-1 C
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      mixed[i][j] = g.metric[at[i][0]] * C[at[0][j]] + g.metric[at[i][1]] * C[at[1][j]] + g.metric[at[i][2]] * C[at[2][j]];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) trace2 = trace2 + mixed[i][j] * mixed[j][i];
  const S i1 = mixed[0][0] + mixed[1][1] + mixed[2][2];
  const S spread = 0.25 * c.lambda * (i1 - 3.0);
  for (int i = 0; i < 3; ++i)
    for (int j = i; j < 3; ++j) {
      const S raised = mixed[i][0] * g.metric[at[0][j]] + mixed[i][1] * g.metric[at[1][j]] + mixed[i][2] * g.metric[at[2][j]];
      const S t = 0.5 * c.mu * (raised - g.metric[at[i][j]]) + spread * g.metric[at[i][j]];
      T[at[i][j]] = i == j ? t : 2.0 * t;
    }
  return 0.25 * c.mu * (trace2 - 2.0 * i1 + 3.0) + 0.5 * spread * (i1 - 3.0);
}

/// Energy [J/m3] at C; T receives its six derivatives. J and dJ are those of volume_ratio().
template <class S>
S law_energy(const LawConstants& c, const LawGeometry<S>& g, const S* C, const S& J, const S* dJ, S* T) noexcept {
  if (c.kind == WallLaw::Kind::linear) return green_energy(c, g, C, T);
  const S inverse = 1.0 / J, spread = J - inverse, stiff = 0.25 * (c.lambda + c.mu) * spread;
  const S pressure = stiff * (1.0 + inverse * inverse) - c.mu;
  for (int m = 0; m < 6; ++m) T[m] = (m < 3 ? 0.5 : 1.0) * c.mu * g.metric[m] + pressure * dJ[m];
  S energy = 0.5 * c.mu * (first_invariant(g, C) - 3.0) + 0.5 * stiff * spread - c.mu * (J - 1.0);
  if (c.c20 > 0.0 || c.growth > 0.0) {
    S slope;
    energy = energy + stiffening_energy(c, S(first_invariant(g, C) - 3.0), slope);
    for (int m = 0; m < 6; ++m) T[m] = T[m] + (m < 3 ? 1.0 : 2.0) * slope * g.metric[m];
  }
  if (!c.tone_slope.empty()) {
    const S way = around(g);
    S slope;
    energy = energy + tone_energy(c, S(way * C[0] - 1.0), slope);
    T[0] = T[0] + slope * way;
  }
  if (c.kind != WallLaw::Kind::fibres) return energy;
  for (const auto& a : g.fibre) {
    S slope;
    energy = energy + fibre_energy(c, S(a[0] * C[0] + a[1] * C[1] + a[2] * C[3] - 1.0), slope);
    T[0] = T[0] + slope * a[0];
    T[1] = T[1] + slope * a[1];
    T[3] = T[3] + slope * a[2];
  }
  return energy;
}

/// Second derivatives of the energy of a point (scalar code: matrices are made at setup, in tests and in validation). `taut`: slack
/// fibres count with the stiffness they have when they tighten.
SixSix law_tangent(const LawConstants& c, const LawGeometry<double>& g, const Six& C, bool taut = false) noexcept;
/// Second derivatives of J.
SixSix volume_ratio_tangent(const LawGeometry<double>& g, const Six& C) noexcept;

}  // namespace filum
