// The trainer's solvers on the rigs against closed forms: heavy elastica, an arc, a compressed block, a square punch.

#include "reconcile/full_solver.h"

#include <gtest/gtest.h>

#include <numbers>

#include "physics/tissue_law.h"

namespace filum::reconcile {
namespace full_solver_test {

TEST(FullSolver, RodOfSmallDeflectionDropsByAnEighth) {
  const HangingRod r = hang_rod(0.02, {}, 40);
  ASSERT_TRUE(r.rests);
  EXPECT_NEAR(r.drop / 0.02 * 8.0, 1.0, 3e-3);
}

/// theta'' = -(1 - s) G cos(theta), theta(0) = 0, theta'(1) = 0: drop by shooting on theta'(0), Runge-Kutta 4 in 2000 steps.
double heavy_elastica(double G) {
  const auto shoot = [&](double bend, double& drop) {
    const int n = 2000;
    const double h = 1.0 / n;
    double th = 0.0, k = bend;
    drop = 0.0;
    for (int i = 0; i < n; ++i) {
      const double s = i * h;
      const auto f = [&](double at, double angle) { return -(1.0 - at) * G * std::cos(angle); };
      const double k1 = k, a1 = f(s, th), k2 = k + 0.5 * h * a1, a2 = f(s + 0.5 * h, th + 0.5 * h * k1), k3 = k + 0.5 * h * a2, a3 = f(s + 0.5 * h, th + 0.5 * h * k2);
      const double k4 = k + h * a3, a4 = f(s + h, th + h * k3), next = th + h / 6.0 * (k1 + 2 * k2 + 2 * k3 + k4);
      drop += h / 6.0 * (std::sin(th) + 4.0 * std::sin(th + 0.5 * h * k2) + std::sin(next));
      th = next;
      k += h / 6.0 * (a1 + 2 * a2 + 2 * a3 + a4);
    }
    return k;
  };
  double low = 0.0, high = G, drop = 0.0;
  for (int i = 0; i < 60; ++i) {
    const double mid = 0.5 * (low + high);
    (shoot(mid, drop) > 0.0 ? high : low) = mid;
  }
  return drop;
}

TEST(FullSolver, RodUnderItsWeightIsTheHeavyElastica) {
  for (const double G : {1.0, 8.0, 40.0}) {
    const HangingRod coarse = hang_rod(G, {}, 30), fine = hang_rod(G, {}, 60);
    ASSERT_TRUE(coarse.rests && fine.rests) << G;
    const double exact = heavy_elastica(G);
    EXPECT_NEAR(fine.drop, exact, 3e-3) << G;
    EXPECT_LT(std::abs(fine.drop - exact), 0.5 * std::abs(coarse.drop - exact) + 1e-5) << G;
  }
}

TEST(FullSolver, RodWithoutWeightKeepsItsNaturalArc) {
  const double kappa = 0.8;
  const HangingRod r = hang_rod(0.0, std::vector<double>(41, kappa), 60);
  ASSERT_TRUE(r.rests);
  EXPECT_NEAR(r.drop, (1.0 - std::cos(kappa)) / kappa, 3e-3);
  EXPECT_NEAR(r.reach, std::sin(kappa) / kappa, 3e-3);
}

TEST(FullSolver, BlockUnderABladeOfItsOwnSizeIsEAOverH) {
  EXPECT_NEAR(press_stiffness(Vec3(10e-3, 8e-3, 5e-3), 10e-3, 8e-3, 0.0, 3) / (10e-3 * 8e-3 / 5e-3), 1.0, 1e-3);
}

TEST(FullSolver, SquareBladeOnDeepTissueIsAPunchOnAHalfSpace) {
  // F/depth = 1.012 (2/sqrt(pi)) sqrt(A) E/(1 - nu^2) without friction (King, Int. J. Solids Struct. 23:1657, 1987); with nu near 1/2 sticking adds
  // little. The box, ten blades wide and deep, stiffens it by some per cent, and so does a mesh that is coarse at the edge.
  const double a = 5e-3, nu = 0.49, half_space = 1.012 * 2.0 / std::sqrt(std::numbers::pi) * a / (1.0 - nu * nu);
  const double coarse = press_stiffness(Vec3(50e-3, 50e-3, 50e-3), a, a, nu, 2) / half_space, fine = press_stiffness(Vec3(50e-3, 50e-3, 50e-3), a, a, nu, 4) / half_space;
  EXPECT_GT(fine, 0.97);
  EXPECT_LT(fine, 1.20);
  EXPECT_LT(std::abs(fine - 1.05), std::abs(coarse - 1.05));
  std::printf("rigid square blade, deep tissue, over the half-space: %.3f and %.3f with finer cells\n", coarse, fine);
}

TEST(FullSolver, DrainageGoesWithTheSquareOfTheSizeAndLosesTheShareAskedFor) {
  const Kernel small = block_drainage({4e-3, 4e-3, 5e-3, true}, 0.48, 0.3, false, 4), large = block_drainage({8e-3, 8e-3, 5e-3, true}, 0.48, 0.3, false, 4);
  EXPECT_NEAR(large.tau[0] / small.tau[0], 4.0, 1e-6);
  EXPECT_NEAR(small.rest, 0.7, 0.01);  // E_d = 0.7 E_u; the open rim's cells are drained at once
  // slowest mode of an unconfined cylinder: J1(x) = x J0(x) (1 - nu)/(1 - 2 nu), nu = 0.036, nearly incompressible: x = 1.86 (Armstrong, Lai & Mow 1984)
  EXPECT_NEAR(small.tau[0] * 1.86 * 1.86 / 4e-6, 1.0, 0.06);
  const Kernel ends = block_drainage({8e-3, 8e-3, 4e-3, false}, 0.48, 0.3, true, 4), high = block_drainage({16e-3, 16e-3, 8e-3, false}, 0.48, 0.3, true, 4);
  EXPECT_NEAR(high.tau[0] / ends.tau[0], 4.0, 1e-6);
  EXPECT_NEAR(ends.rest, 0.7, 0.05);
  // on deep tissue a punch's stiffness is as G/(1 - nu): the share asked for is lost but for the box's walls
  const Kernel blade = press_drainage(Vec3(50e-3, 50e-3, 50e-3), 5e-3, 5e-3, 0.48, 0.3, 2);
  EXPECT_NEAR(blade.rest, 0.7, 0.05);
}

TEST(FullSolver, PlatenFrictionStartsAsBettisTheoremAndEndsAsABondedBlock) {
  // to first order the tractions mu p inwards work through the free block's widening nu r/h on both faces: 1 + (2/3) mu nu D/h (Betti); with nu = 1/2 Siebel's 1 + mu D/(3 h)
  const Block disc{8e-3, 8e-3, 4e-3, true};
  const double nu = 0.45, mu = 0.02, first = 2.0 / 3.0 * mu * nu * 2.0;
  const double coarse = platen_stiffening(disc, nu, mu, 4), fine = platen_stiffening(disc, nu, mu, 8);
  EXPECT_NEAR((fine - 1.0) / first, 1.0, 0.06);
  EXPECT_NEAR(coarse / fine, 1.0, 3e-3);
  EXPECT_NEAR(platen_stiffening(disc, nu, 0.0, 4), 1.0, 2e-3);
  // bonded, nearly incompressible: 1 + 2 S^2, S = D/(4 h) (Gent & Lindley, Proc. Inst. Mech. Eng. 173:111, 1959)
  const Block flat{16e-3, 16e-3, 4e-3, true};
  const double held = platen_stiffening(flat, 0.49, 50.0, 8);
  EXPECT_NEAR(held / 3.0, 1.0, 0.15);
  EXPECT_LT(platen_stiffening(flat, 0.49, 0.1, 8), held);
  std::printf("block D = 2 h, mu 0.02: %.4f of Betti's first order; bonded D = 4 h: %.3f (Gent & Lindley 3)\n", (fine - 1.0) / first, held);
}

/// A press of strain 0.1 on 40 x 40 x 20 mm by a blade of 10 x 5 mm.
PressTable pressed(const TissueLaw& law, const std::function<double(double, double)>& reduced, int cells) {
  const Vec3 box(40e-3, 40e-3, 20e-3);
  const double square = local_strain_square(pressed_box(box, 10e-3, 5e-3, 2), box.z(), 0.45);
  EXPECT_GT(square, 1.5);  // deep tissue is strained near the blade
  return press_table(pressed_box(box, 10e-3, 5e-3, cells), box.z(), 0.45, law, square, 0.1, reduced);
}

TEST(FullSolver, ABladeOnStiffeningTissueAgreesWithDepthOverHeightToFirstOrder) {
  TissueLaw law;
  law.stiffening = 1e-3 / (6.0 * 0.01);  // a thousandth of the force at the peak
  const auto linear = [](double e, double) { return e; };
  const PressTable weak = pressed(law, linear, 2);
  ASSERT_FALSE(weak.load.empty());
  EXPECT_NEAR(weak.load.back() / (1e-3 * 0.1), 1.0, 0.15);  // the volume change, which does not stiffen, has a share of the energy
  EXPECT_EQ(weak.load, weak.unload);
  law.stiffening *= 400.0;
  const PressTable strong = pressed(law, linear, 2), fine = pressed(law, linear, 3);
  ASSERT_FALSE(strong.load.empty() || fine.load.empty());
  EXPECT_LT(strong.load.back(), 400.0 * weak.load.back());  // the field gives way where it stiffens most
  EXPECT_GT(strong.load.back(), 150.0 * weak.load.back());
  EXPECT_NEAR(fine.load.back() / strong.load.back(), 1.0, 0.25);
  std::printf("stiffening by 0.4 of the force at the peak: %.3f and %.3f of it on the mesh and a finer one\n", strong.load.back() / 0.04, fine.load.back() / 0.04);
}

TEST(FullSolver, AStickingBladePullsAsTheTissueDoesAndComesOffAtItsTraction) {
  Dataset d;
  d.rig = Rig::spatula_press;
  d.outputs = {"force"};
  for (const ParameterInfo& p : info(d.rig).baseline) d.nominal[p.name] = p.nominal, d.free.push_back(p.name);
  Trial t;
  t.time = Eigen::VectorXd::LinSpaced(401, 0.0, 4.0);
  t.specimen = {{"length", 60e-3}, {"width", 50e-3}, {"height", 30e-3}, {"blade_length", 20e-3}, {"blade_width", 10e-3}};
  t.data["depth"] = 2e-3 * (1.0 - t.time.array());  // pressed by 2 mm, drawn up to 6 mm above the surface
  t.data["force"] = Eigen::VectorXd::Zero(401);
  d.trials.push_back(t);
  const auto model = make_model(d);
  const auto full = make_full_solver(*model);
  const double base[] = {3e3, 0.45}, area = 20e-3 * 10e-3, stiffness = 3e3 * press_stiffness(Vec3(60e-3, 50e-3, 30e-3), 20e-3, 10e-3, 0.45, 3);
  const double traction = 1e-3 * stiffness / area, values[] = {traction, 3e-3};  // reached when drawn by 1 mm
  for (const int form : {0, 2}) {
    Setting s;
    s.base = base;
    s.p[static_cast<std::size_t>(index_of(Effect::contact_adhesion))] = values;
    s.kind[static_cast<std::size_t>(index_of(Effect::contact_adhesion))] = form;
    Eigen::MatrixXd out;
    ASSERT_TRUE(full->run(t, s, false, out));
    EXPECT_NEAR(out(0, 0), stiffness * 2e-3, 1e-9 * stiffness);
    EXPECT_NEAR(out.minCoeff() / (-traction * area), 1.0, form == 0 ? 0.025 : 1e-9) << form;  // a sample is 0.02 mm
    const double last = form == 0 ? 1e-3 : 3e-3;
    for (int n = 0; n < 401; ++n) {
      if (const double lift = -t.at("depth")[n]; lift > last + 2.1e-5) {
        EXPECT_EQ(out(n, 0), 0.0) << form << " at " << lift;
      }
    }
  }
}

TEST(FullSolver, ABladeComesBackWithWhatHasSetAndSoftened) {
  TissueLaw set;
  set.set = 0.1;
  // the same share everywhere: unloaded, the linear tissue asks for a tenth less motion, but for the elements whose peak had another direction
  const PressTable s = pressed(set, [](double e, double most) { return e - 0.1 * most; }, 2);
  ASSERT_FALSE(s.load.empty());
  for (const double c : s.unload) EXPECT_NEAR(c, 0.0, 2e-3);
  TissueLaw soft;
  soft.softening = 0.3;
  soft.softening_energy = 1e-3;
  const PressTable w = pressed(soft, [](double e, double) { return e; }, 2);
  ASSERT_FALSE(w.load.empty());
  EXPECT_NEAR(w.load.back(), 0.0, 1e-3);
  EXPECT_LT(w.unload[2], -0.03 * 0.04);
  EXPECT_GT(w.unload[2], -0.3 * 0.04);
}

}  // namespace full_solver_test
}  // namespace filum::reconcile
