#include "physics/hyperelastic.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

using namespace filum;

namespace hyperelastic_test {

Eigen::Matrix3d matrix_of(const Six& C) {
  Eigen::Matrix3d m;
  m << C[0], C[3], C[5], C[3], C[1], C[4], C[5], C[4], C[2];
  return m;
}

/// An oblique basis and fibres in its first two directions.
LawGeometry<double> oblique(const Six& G) {
  const Eigen::Matrix3d up = matrix_of(G).inverse();
  return {{up(0, 0), up(1, 1), up(2, 2), up(0, 1), up(1, 2), up(0, 2)},
          1.0 / std::sqrt(matrix_of(G).determinant()),
          {{0.6, 0.3, 0.5}, {0.6, 0.3, -0.5}}};
}

const Six kRest = (Six() << 1.2, 0.8, 1.0, 0.2, -0.1, 0.15).finished();
const Six kStrained = (Six() << 1.7, 1.1, 0.7, 0.3, -0.05, 0.1).finished();

WallLaw fibres() {
  WallLaw law;
  law.kind = WallLaw::Kind::fibres;
  law.mu = 3e3;
  law.lambda = 1e5;
  law.k1 = 2.4e3;
  law.k2 = 0.84;
  return law;
}

double energy(const WallLaw& law, const Six& C, Six* T = nullptr) {
  const auto g = oblique(kRest);
  Six dJ, own;
  const double J = volume_ratio(g, C.data(), dJ.data());
  return law_energy(LawConstants(law), g, C.data(), J, dJ.data(), T ? T->data() : own.data());
}

void check_derivatives(const WallLaw& law) {
  const double h = 1e-6;
  Six T;
  energy(law, kStrained, &T);
  const SixSix D = law_tangent(LawConstants(law), oblique(kRest), kStrained);
  for (int m = 0; m < 6; ++m) {
    const Six step = h * Six::Unit(m);
    Six up, down;
    const double slope = (energy(law, kStrained + step, &up) - energy(law, kStrained - step, &down)) / (2.0 * h);
    EXPECT_NEAR(slope, T[m], 1e-6 * T.norm()) << m;
    EXPECT_LT(((up - down) / (2.0 * h) - D.col(m)).norm(), 1e-6 * D.norm()) << m;
  }
}

TEST(Hyperelastic, DerivativesOfEveryLaw) {
  check_derivatives(WallLaw::hooke(10e3, 0.3));
  WallLaw rubber = fibres();
  rubber.kind = WallLaw::Kind::neo_hookean;
  check_derivatives(rubber);
  check_derivatives(fibres());
  WallLaw stiffening = fibres();
  stiffening.kind = WallLaw::Kind::neo_hookean;
  stiffening.c20 = 5e3;
  check_derivatives(stiffening);
  stiffening.growth = 1.5;
  check_derivatives(stiffening);
  WallLaw active = fibres();
  for (const auto shape : {MuscleTone::Shape::parabola, MuscleTone::Shape::bell}) {
    active.tone = {shape, 20e3, 1.25};
    check_derivatives(active);
  }
}

TEST(Hyperelastic, VolumeRatioAndItsDerivatives) {
  const auto g = oblique(kRest);
  Six dJ;
  const double J = volume_ratio(g, kStrained.data(), dJ.data());
  EXPECT_NEAR(J * J, matrix_of(kStrained).determinant() / matrix_of(kRest).determinant(), 1e-13);
  const SixSix D = volume_ratio_tangent(g, kStrained);
  for (int m = 0; m < 6; ++m) {
    const Six up = kStrained + 1e-6 * Six::Unit(m), down = kStrained - 1e-6 * Six::Unit(m);
    Six a, b;
    EXPECT_NEAR((volume_ratio(g, up.data(), a.data()) - volume_ratio(g, down.data(), b.data())) / 2e-6, dJ[m], 1e-8);
    EXPECT_LT(((a - b) / 2e-6 - D.col(m)).norm(), 1e-7);
  }
}

TEST(Hyperelastic, StressFreeAtRest) {
  for (const auto kind : {WallLaw::Kind::linear, WallLaw::Kind::neo_hookean, WallLaw::Kind::fibres}) {
    WallLaw law = fibres();
    law.kind = kind;
    Six T;
    auto g = oblique(kRest);
    g.fibre[0][0] = g.fibre[1][0] = 0.5;  // shorter than 1 at rest: slack
    Six dJ;
    const double J = volume_ratio(g, kRest.data(), dJ.data());
    EXPECT_NEAR(law_energy(LawConstants(law), g, kRest.data(), J, dJ.data(), T.data()), 0.0, 1e-9);
    EXPECT_LT(T.norm(), 1e-9);
  }
}

TEST(Hyperelastic, SlackFibresBearNothing) {
  const LawConstants c(fibres());
  double slope = 1.0;
  EXPECT_EQ(fibre_energy(c, -0.2, slope), 0.0);
  EXPECT_EQ(slope, 0.0);
  EXPECT_NEAR(fibre_energy(c, 0.3, slope), 2.4e3 / 1.68 * (std::exp(0.84 * 0.09) - 1.0), 1e-9);
  EXPECT_NEAR(slope, 2.4e3 * 0.3 * std::exp(0.84 * 0.09), 1e-9);
}

TEST(Hyperelastic, ExponentialEndsSmoothly) {
  const LawConstants c(fibres());
  double below = 0.0, above = 0.0;
  const double end = c.strain_end, e0 = fibre_energy(c, end - 1e-7, below), e1 = fibre_energy(c, end + 1e-7, above);
  EXPECT_NEAR(below / above, 1.0, 1e-5);
  EXPECT_NEAR((e1 - e0) / 2e-7 / above, 1.0, 1e-5);
}

/// Simple shear keeps the volume, I1 - 3 = g^2: stress mu g + 4 c20 g^3.
TEST(Hyperelastic, YeohInSimpleShear) {
  WallLaw law = fibres();
  law.kind = WallLaw::Kind::neo_hookean;
  law.c20 = 5e3;
  const LawGeometry<double> g{{1, 1, 1, 0, 0, 0}, 1.0, {}};
  for (const double shear : {0.1, 0.5, 1.2}) {
    const Six C = (Six() << 1.0, 1.0 + shear * shear, 1.0, shear, 0.0, 0.0).finished();
    Six dJ, T;
    const double J = volume_ratio(g, C.data(), dJ.data());
    law_energy(LawConstants(law), g, C.data(), J, dJ.data(), T.data());
    EXPECT_NEAR(T[3] + 2.0 * shear * T[1], law.mu * shear + 4.0 * law.c20 * std::pow(shear, 3), 1e-9 * law.mu);  // dPsi/dg
  }
}

/// Simple shear: dPsi/dg = mu g exp(b g^2), beyond the largest exponent a straight line of dPsi/dI1.
TEST(Hyperelastic, ExponentialStiffeningInSimpleShear) {
  WallLaw law = fibres();
  law.kind = WallLaw::Kind::neo_hookean;
  law.growth = 4.0;
  const LawGeometry<double> g{{1, 1, 1, 0, 0, 0}, 1.0, {}};
  const auto stress = [&](double shear) {
    const Six C = (Six() << 1.0, 1.0 + shear * shear, 1.0, shear, 0.0, 0.0).finished();
    Six dJ, T;
    const double J = volume_ratio(g, C.data(), dJ.data());
    law_energy(LawConstants(law), g, C.data(), J, dJ.data(), T.data());
    return T[3] + 2.0 * shear * T[1];
  };
  for (const double shear : {0.1, 0.5, 1.2}) EXPECT_NEAR(stress(shear) / (law.mu * shear * std::exp(4.0 * shear * shear)), 1.0, 1e-12);
  const double end = std::sqrt(kLargestExponent / 4.0), top = std::exp(kLargestExponent), beyond = 1.2 * 1.2 * end * end - end * end;
  EXPECT_NEAR(stress(1.2 * end) / (law.mu * 1.2 * end * top * (1.0 + 4.0 * beyond)), 1.0, 1e-9);
}

/// Stretched by l along the first direction, tone adds l dPsi/dl = S f(l) to the stress there and nothing elsewhere.
TEST(Hyperelastic, ToneIsItsStressAroundTheVessel) {
  WallLaw passive = fibres(), active = fibres();
  const LawGeometry<double> g{{1, 1, 1, 0, 0, 0}, 1.0, {{0.6, 0.4, 0.1}, {0.6, 0.4, -0.1}}};
  for (const auto shape : {MuscleTone::Shape::parabola, MuscleTone::Shape::bell}) {
    active.tone = {shape, 20e3, 1.25};
    for (const double l : {0.9, 1.0, 1.1, 1.25, 1.4, 1.6}) {
      const Six C = (Six() << l * l, 1.1, 1.0 / (1.1 * l * l), 0.0, 0.0, 0.0).finished();
      Six dJ, without, with;
      const double J = volume_ratio(g, C.data(), dJ.data());
      law_energy(LawConstants(passive), g, C.data(), J, dJ.data(), without.data());
      law_energy(LawConstants(active), g, C.data(), J, dJ.data(), with.data());
      EXPECT_NEAR(2.0 * l * l * (with[0] - without[0]), 20e3 * active.tone.share(l), 0.5) << l;
      EXPECT_EQ((with - without).tail<5>().norm(), 0.0);
    }
    EXPECT_NEAR(active.tone.share(1.25), shape == MuscleTone::Shape::parabola ? 1.0 : 1.0 - std::exp(-std::pow(0.25 / 0.15, 2)), 1e-12);
    EXPECT_EQ(active.tone.share(1.0), 0.0);
    EXPECT_EQ(active.tone.share(1.51), 0.0);
  }
}

TEST(Hyperelastic, HookeConstants) {
  const WallLaw law = WallLaw::hooke(10e3, 0.25);
  EXPECT_DOUBLE_EQ(law.mu, 4e3);
  EXPECT_DOUBLE_EQ(law.lambda, 4e3);
  EXPECT_NEAR(law.lambda_point(), 10e3 * 0.25 / (1.0 - 0.0625), 1e-9);  // plane stress: E nu / (1 - nu^2)
}

}  // namespace hyperelastic_test
