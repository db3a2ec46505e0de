// The trainer's wall elements on an inflated tube against Lame's closed form and the reduced model's quadrature.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "physics/tube_slice.h"
#include "reconcile/full_solver.h"

namespace filum::reconcile {
namespace full_tube_test {

const TubeWall kTube{0.7e-3, 1.0e-3};

TEST(FullTube, LinearPartIsLames) {
  const double coarse = tube_linear_factor(kTube, 16), fine = tube_linear_factor(kTube, 32);
  std::printf("Lame over finite elements, 16 and 32 around: %.5f %.5f\n", coarse, fine);
  EXPECT_NEAR(coarse, 1.0, 0.03);
  EXPECT_NEAR(fine, 1.0, 0.01);
  EXPECT_LT(std::abs(fine - 1.0), 0.4 * std::abs(coarse - 1.0) + 1e-4);
}

WallLaw law(WallLaw::Kind kind) {
  WallLaw l;
  l.kind = kind;
  l.mu = 50e3;
  l.lambda = 1e3 * l.mu;
  return l;
}

/// int f(l^2, stretch) dr/r at motion C and axial stretch, l the stretch around, midpoint rule.
template <class Stress>
double over_the_wall(double C, double stretch, const Stress& stress) {
  constexpr int kPoints = 1000;
  const double ri = std::sqrt(kTube.inner * kTube.inner / stretch + 2 * C), ro = std::sqrt(kTube.outer * kTube.outer / stretch + 2 * C);
  double sum = 0.0;
  for (int i = 0; i < kPoints; ++i) {
    const double r = ri + (ro - ri) * (i + 0.5) / kPoints;
    sum += (ro - ri) / kPoints * stress(r * r / ((r * r - 2 * C) * stretch)) / r;
  }
  return sum;
}

/// Pressures that the elements give lie within 2 % of the quadrature of `stress` (a difference of stresses by the square of the stretch around).
void expect_quadrature(const WallLaw& l, const std::function<double(double)>& stress) {
  const auto reduced = [&](double C, double) { return over_the_wall(C, 1.0, stress); };
  const WallTable t = tube_table(kTube, l, 0.0, {1.0}, 0.15 * kTube.outer * kTube.outer, reduced, 24);
  ASSERT_TRUE(std::isfinite(t.linear));
  ASSERT_EQ(t.slices.size(), 1u);
  ASSERT_EQ(t.slices[0].C.size(), 7u);
  EXPECT_GT(reduced(t.slices[0].C.back(), 1.0), 1e3);
  for (std::size_t i = 1; i < t.slices[0].C.size(); ++i) EXPECT_LT(std::abs(t.slices[0].beyond[i]), 0.02 * reduced(t.slices[0].C[i], 1.0) + 20.0) << t.slices[0].C[i];
}

TEST(FullTube, FibresAreThoseOfTheQuadrature) {
  WallLaw l = law(WallLaw::Kind::fibres);
  const double k1 = 40e3, k2 = 3.0, angle = 40.0 * std::numbers::pi / 180.0, c2 = std::pow(std::cos(angle), 2);
  l.k1 = 0.25 * k1, l.k2 = 0.25 * k2, l.beta = angle;
  expect_quadrature(l, [&](double l2) {
    const double e = 0.5 * c2 * (l2 - 1.0);
    return 2 * k1 * e * std::exp(k2 * e * e) * c2 * l2;
  });
}

TEST(FullTube, StiffeningIsThatOfTheQuadrature) {
  WallLaw l = law(WallLaw::Kind::neo_hookean);
  l.c20 = 25e3;
  expect_quadrature(l, [&](double l2) { return 4 * l.c20 * (l2 + 1 / l2 - 2) * (l2 - 1 / l2); });
}

/// Lame's wall held in plane strain carries 2 nu pi a^2 P along its axis, which is what P does on a closed end: nothing is left of it; stretched, E e A.
TEST(FullTube, AxialForceOfTheLinearTubeIsLames) {
  const double coarse = tube_axial_factor(kTube, 16), fine = tube_axial_factor(kTube, 32);
  std::printf("axial force of a tube a little longer over E e A, 16 and 32 around: %.5f %.5f\n", coarse, fine);
  EXPECT_NEAR(coarse, 1.0, 0.005);
  EXPECT_NEAR(fine, 1.0, 0.002);
  constexpr double kPoisson = 0.4999, E = 3e5, P = 3.0;
  TubeSlice slice;
  slice.shape.inner_radius = kTube.inner, slice.shape.thickness = kTube.outer - kTube.inner, slice.shape.length = 0.1e-3;
  slice.around = 32, slice.through = 8;
  slice.layers = {{"wall", slice.shape.thickness, WallLaw::hooke(E, kPoisson)}};
  const SliceState at = inflate(slice, {P})[0];
  ASSERT_TRUE(at.converged);
  EXPECT_NEAR(at.axial_force / (2 * kPoisson * P * at.lumen), 1.0, 0.005);
  EXPECT_NEAR(at.lumen / (std::numbers::pi * kTube.inner * kTube.inner), 1.0, 0.01);
}

TEST(FullTube, ExponentialStiffeningIsThatOfTheQuadrature) {
  WallLaw l = law(WallLaw::Kind::neo_hookean);
  l.growth = 6.0;
  const auto exact = [&](double C, double) {
    return over_the_wall(C, 1.0, [&](double l2) { return l.mu * std::expm1(l.growth * (l2 + 1 / l2 - 2)) * (l2 - 1 / l2); });
  };
  const double most = 0.15 * kTube.outer * kTube.outer;
  const WallTable t = tube_table(kTube, l, 0.0, {1.0}, most, exact, 24);
  ASSERT_TRUE(std::isfinite(t.linear));
  EXPECT_GT(exact(most, 1.0), 5e3);
  double worst = 0.0;
  for (std::size_t i = 1; i < t.slices[0].C.size(); ++i) worst = std::max(worst, std::abs(t.slices[0].beyond[i]) / exact(most, 1.0));
  std::printf("exponential stiffening: finite elements off the quadrature by %.4f of its most\n", worst);
  EXPECT_LT(worst, 0.02);
}

TEST(FullTube, ToneIsThatOfTheQuadrature) {
  const double most = 0.15 * kTube.outer * kTube.outer;
  for (const auto shape : {MuscleTone::Shape::parabola, MuscleTone::Shape::bell}) {
    WallLaw l = law(WallLaw::Kind::neo_hookean);
    l.tone = {shape, 20e3, 1.15};
    const auto exact = [&](double C, double) { return over_the_wall(C, 1.0, [&](double l2) { return l.tone.stress * l.tone.share(std::sqrt(l2)); }); };
    double worst[2] = {0.0, 0.0};
    for (int fine = 0; fine < 2; ++fine) {
      const WallTable t = tube_table(kTube, l, 0.0, {1.0}, most, exact, fine ? 32 : 16);
      ASSERT_TRUE(std::isfinite(t.linear));
      for (std::size_t i = 1; i < t.slices[0].C.size(); ++i) worst[fine] = std::max(worst[fine], std::abs(t.slices[0].beyond[i]) / exact(0.5 * most, 1.0));
    }
    std::printf("tone: finite elements off the quadrature by %.4f and %.4f, 16 and 32 around\n", worst[0], worst[1]);
    EXPECT_LT(worst[0], 0.03);
    EXPECT_LT(worst[1], 0.01);
  }
}

/// Fibres at 40 degrees and Yeoh's stiffening together in a tube held 10 % longer: the fibres pull it in before there is any pressure.
TEST(FullTube, StretchedTubeIsThatOfTheQuadrature) {
  WallLaw l = law(WallLaw::Kind::fibres);
  const double k1 = 40e3, k2 = 3.0, angle = 40.0 * std::numbers::pi / 180.0, c2 = std::pow(std::cos(angle), 2);
  l.k1 = 0.25 * k1, l.k2 = 0.25 * k2, l.beta = angle;
  l.c20 = 15e3;
  const auto exact = [&](double C, double lz) {
    return over_the_wall(C, lz, [&](double l2) {
      const double e = 0.5 * (c2 * (l2 - 1) + (1 - c2) * (lz * lz - 1)), radial = 1 / (l2 * lz * lz);
      return 2 * k1 * std::max(e, 0.0) * std::exp(k2 * e * e) * c2 * l2 + 4 * l.c20 * (l2 + lz * lz + radial - 3) * (l2 - radial);
    });
  };
  const double most = 0.12 * kTube.outer * kTube.outer;
  for (const double lz : {0.97, 1.1}) {
    const WallTable t = tube_table(kTube, l, 0.0, {lz}, most, exact, 24);
    ASSERT_TRUE(std::isfinite(t.linear)) << lz;
    const auto& s = t.slices[0];
    double low = -0.1 * most, high = 0.1 * most;  // where the quadrature has no pressure
    const auto whole = [&](double C) { return exact(C, lz) + over_the_wall(C, lz, [&](double l2) { return l.mu * (l2 - 1 / (l2 * lz * lz)); }); };
    for (int i = 0; i < 60; ++i) (whole(0.5 * (low + high)) > 0 ? high : low) = 0.5 * (low + high);
    EXPECT_NEAR(s.C[0], low, 0.02 * std::abs(low) + 3e-5 * kTube.outer * kTube.outer);  // bulk of 1,000 mu, a stretch of 3 %
    EXPECT_LT(lz > 1.0 ? s.C[0] : -1.0, -0.01 * most);
    double worst = 0.0;
    for (const double beyond : s.beyond) worst = std::max(worst, std::abs(beyond) / exact(most, lz));
    std::printf("stretch %.2f: motion without pressure %.4f b^2, finite elements off the quadrature by %.4f of its most\n", lz, s.C[0] / (kTube.outer * kTube.outer), worst);
    EXPECT_LT(worst, 0.02);
  }
}

/// pi int (2 s_z - s_theta) r dr at motion C and axial stretch, stresses less the radial one, of (stretch around, radial stretch) squared, midpoint rule.
template <class Stress>
double along_the_wall(double C, double lz, const Stress& stress) {
  constexpr int kPoints = 1000;
  double sum = 0.0;
  for (int i = 0; i < kPoints; ++i) {
    const double R = kTube.inner + (kTube.outer - kTube.inner) * (i + 0.5) / kPoints, l2 = 1 / lz + 2 * C / (R * R);
    sum += stress(l2, 1 / (l2 * lz * lz)) * R / lz;
  }
  return sum * std::numbers::pi * (kTube.outer - kTube.inner) / kPoints;
}

/// The tube of StretchedTubeIsThatOfTheQuadrature, the force on its end less that of the pressure on a closed one.
TEST(FullTube, AxialForceIsThatOfTheQuadrature) {
  WallLaw l = law(WallLaw::Kind::fibres);
  const double k1 = 40e3, k2 = 3.0, angle = 40.0 * std::numbers::pi / 180.0, c2 = std::pow(std::cos(angle), 2);
  l.k1 = 0.25 * k1, l.k2 = 0.25 * k2, l.beta = angle;
  l.c20 = 15e3;
  const auto around = [&](double l2, double lz, double radial) {
    const double e = std::max(0.5 * (c2 * (l2 - 1) + (1 - c2) * (lz * lz - 1)), 0.0);
    return 2 * k1 * e * std::exp(k2 * e * e) * c2 * l2 + 4 * l.c20 * (l2 + lz * lz + radial - 3) * (l2 - radial);
  };
  const auto along = [&](double l2, double lz, double radial) {
    const double e = std::max(0.5 * (c2 * (l2 - 1) + (1 - c2) * (lz * lz - 1)), 0.0);
    return 2 * k1 * e * std::exp(k2 * e * e) * (1 - c2) * lz * lz + 4 * l.c20 * (l2 + lz * lz + radial - 3) * (lz * lz - radial);
  };
  const auto pressure = [&](double C, double lz) { return over_the_wall(C, lz, [&](double l2) { return around(l2, lz, 1 / (l2 * lz * lz)); }); };
  const auto exact = [&](double C, double lz) { return along_the_wall(C, lz, [&](double l2, double radial) { return 2 * along(l2, lz, radial) - around(l2, lz, radial); }); };
  const double most = 0.12 * kTube.outer * kTube.outer;
  for (const double lz : {0.97, 1.0, 1.1}) {
    double worst[2] = {0.0, 0.0}, size = 0.0;
    for (int fine = 0; fine < 2; ++fine) {
      const WallTable t = tube_table(kTube, l, 0.0, {lz}, most, pressure, fine ? 32 : 16, exact);
      ASSERT_TRUE(std::isfinite(t.linear)) << lz;
      const auto& s = t.slices[0];
      ASSERT_EQ(s.axial.size(), s.C.size());
      for (std::size_t i = 0; i < s.C.size(); ++i) {
        // what pulls along the axis and what the stress around takes from it cancel in a tube that keeps its length: the larger counts
        size = std::max(size, std::abs(along_the_wall(s.C[i], lz, [&](double l2, double radial) { return 2 * along(l2, lz, radial); })));
        worst[fine] = std::max(worst[fine], std::abs(s.axial[i]));
      }
    }
    std::printf("stretch %.2f: fibres and stiffening pull along the axis with up to %.3g mN, finite elements off the quadrature by %.4f and %.4f of it\n", lz, 1e3 * size, worst[0] / size, worst[1] / size);
    EXPECT_GT(size, 5e-4);
    EXPECT_LT(worst[0], 0.005 * size) << lz;
    EXPECT_LT(worst[1], 0.002 * size) << lz;
  }
}

/// Share of the pressure left at motion C after a largest one: int s(R) R^-3 dR over int R^-3 dR, an element's energy as its own strain C/R^2 has it.
TEST(FullTube, SofteningIsThatOfTheQuadrature) {
  const double a = kTube.inner, b = kTube.outer, most = 0.12 * a * b;
  const WallSoftening soft{WallSoftening::Shape::exponential, 0.35, 0.3 * 0.5 * 0.12 * 0.12};
  const WallTable::Softened t = tube_softening(kTube, soft, most, 24);
  ASSERT_EQ(t.top.size(), 5u);
  double worst = 0.0, apart = 0.0;
  for (const double top : {0.5 * most, 0.75 * most, most})
    for (const double share : {0.3, 0.5, 0.7, 0.85}) {
      double exact = 0.0, firm = 0.0;
      for (int i = 0; i < 1000; ++i) {
        const double R = a + (b - a) * (i + 0.5) / 1000, W = 0.5 * std::pow(top / (R * R), 2);
        firm += 1.0 / (R * R * R);
        exact += soft.left(W * share * share, W) / (R * R * R);
      }
      const double W = 0.5 * std::pow(top / (a * b), 2), reduced = soft.left(W * share * share, W);
      worst = std::max(worst, std::abs(reduced + t.at(share * top, top) - exact / firm));
      apart = std::max(apart, std::abs(reduced - exact / firm));
    }
  std::printf("softening: finite elements off the quadrature by %.4f of the stress, the reduced law by %.4f\n", worst, apart);
  EXPECT_LT(worst, 0.004);
  EXPECT_EQ(t.at(most, most), 0.0);
}

TEST(FullTube, OpeningAngleIsTheSectorsPressure) {
  // without what the reduced model says the table is the whole pressure of the closed sector beyond the ring's; here against its own quadrature
  const double angle = 100.0 * std::numbers::pi / 180.0, k = 1.0 / (1.0 - angle / (2 * std::numbers::pi)), mu = 50e3, a = kTube.inner, b = kTube.outer;
  const auto pressure = [&](double K, double C, double R) {
    double P = 0.0;
    const double ri = std::sqrt(a * a + 2 * C), ro = std::sqrt(b * b + 2 * C);
    for (int i = 0; i < 400; ++i) {
      const double r = ri + (ro - ri) * (i + 0.5) / 400, l = r * K / std::sqrt(R * R + K * (r * r - ri * ri));
      P += (ro - ri) / 400 * mu * (l * l - 1 / (l * l)) / r;
    }
    return P;
  };
  double low = 0.2 * a, high = 6 * a * k;
  for (int i = 0; i < 50; ++i) (pressure(k, 0.0, 0.5 * (low + high)) > 0 ? low : high) = 0.5 * (low + high);
  const WallTable t = tube_table(kTube, law(WallLaw::Kind::neo_hookean), angle, {1.0}, 0.1 * b * b, [](double, double) { return 0.0; }, 24);
  ASSERT_TRUE(std::isfinite(t.linear));
  const double whole = pressure(1.0, 0.1 * b * b, a);
  for (std::size_t i = 1; i < t.slices[0].C.size(); ++i) EXPECT_NEAR(t.slices[0].beyond[i], pressure(k, t.slices[0].C[i], low) - pressure(1.0, t.slices[0].C[i], a), 0.01 * whole) << i;
}

}  // namespace full_tube_test
}  // namespace filum::reconcile
