// Drainage on a mesh against closed forms of Biot's theory with fluid that is held by a finite Q:
//   confined (a column, one end open)   p = cos(b z) - cos b,  tan b = -b M/Q           (Q to infinity: b = n pi, the biphasic stress relaxation)
//   unconfined cylinder                 p = J0(a r) - J0(a),   (1/Q + 1/M) J0 = G (2 J1/a - J0)/(M (M - G))
//                                       (Q to infinity: a J0 (1 - nu)/(1 - 2 nu) = J1, Armstrong, Lai & Mow, J. Biomech. Eng. 106:165, 1984)
// times size^2/(D b^2); weights (b.p)^2/(p.A p).

#include "physics/pore_flow.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "base/error.h"

namespace filum {
namespace pore_flow_test {

constexpr double kPi = std::numbers::pi;

double root(const std::function<double(double)>& f, double low, double high) {
  const bool rising = f(high) > 0.0;
  for (int i = 0; i < 80; ++i) {
    const double mid = 0.5 * (low + high);
    ((f(mid) > 0.0) == rising ? high : low) = mid;
  }
  return 0.5 * (low + high);
}

double left_after(const DrainingForce& f, double t) {
  double sum = f.rest;
  for (std::size_t i = 0; i < f.weight.size(); ++i) sum += f.weight[i] * std::exp(-t / f.time[i]);
  return sum;
}

struct Moduli {
  double G, M, Q;
};
Moduli moduli(const FemMaterial& m, const Drainage& d) {
  const PoreLaw law = pore_law(m, d, "test");
  const double G = law.drained.young / (2.0 * (1.0 + law.drained.poisson)), K = law.drained.young / (3.0 * (1.0 - 2.0 * law.drained.poisson));
  return {G, K + 4.0 / 3.0 * G, law.Q};
}

/// Column of height 1 and side 1/n, open at the top, moved there.
DrainingBody column(int n, const FemMaterial& tissue, const Drainage& d) {
  DrainingBody b{box_mesh(Vec3::Zero(), Vec3(1.0 / n, 1.0 / n, 1.0), 1, 1, n), tissue, d, {}, {}, {}};
  b.motion = Points::Zero(3, b.mesh.n_nodes());
  for (int i = 0; i < b.mesh.n_nodes(); ++i) {
    const bool top = b.mesh.nodes(2, i) > 1.0 - 1e-9, bottom = b.mesh.nodes(2, i) < 1e-9;
    for (const bool held : {true, true, top || bottom}) b.held.push_back(held);
    b.open.push_back(top);
    if (top) b.motion(2, i) = -1.0;
  }
  return b;
}

TEST(PoreFlow, ConfinedColumnRelaxesAsInClosedForm) {
  const FemMaterial tissue{3e3, 0.45, 1000.0};
  const Drainage d{1e-3, 0.1};
  const auto [G, M, Q] = moduli(tissue, d);
  const double area[] = {1.0 / 400, 1.0 / 1600};
  double before = 0.0;
  for (const int level : {0, 1}) {
    const int n = level == 0 ? 20 : 40;
    const DrainingForce f = draining_force(column(n, tissue, d));
    EXPECT_NEAR(f.rest / (area[level] * M), 1.0, 1e-9);
    EXPECT_NEAR(f.sudden() / (area[level] * (M + Q)), 1.0, 0.05);  // the open node's own share of the column is drained at once
    double worst = 0.0;
    for (const double T : {0.01, 0.03, 0.1, 0.3}) {
      double sum = M;
      for (int k = 1; k <= 60; ++k) {
        const double b = root([ratio = M / Q](double x) { return std::cos(x) * ratio + std::sin(x) / x; }, (k - 0.5) * kPi, k * kPi), c = std::cos(b), m = std::sin(b) / b - c;
        const double pp = 0.5 + std::sin(2 * b) / (4 * b) - 2 * c * std::sin(b) / b + c * c;
        sum += m * m / ((1 / Q + 1 / M) * pp - m * m / M) * std::exp(-b * b * T);
      }
      worst = std::max(worst, std::abs(left_after(f, T / d.diffusivity) / (area[level] * sum) - 1.0));
    }
    std::printf("confined column, %d cells: largest error %.2e\n", n, worst);
    EXPECT_LT(worst, level == 0 ? 0.02 : 0.005);
    if (level == 1) {
      EXPECT_LT(worst, 0.35 * before);  // second order
    }
    before = worst;
  }
}

/// Quarter of a cylinder of radius 1, one cell high, between platens without friction.
DrainingBody disc(int n, const FemMaterial& tissue, const Drainage& d) {
  DrainingBody b{box_mesh(Vec3::Zero(), Vec3(n, n, 1.0), n, n, 1), tissue, d, {}, {}, {}};
  b.mesh.nodes.row(2) /= n;
  b.motion = Points::Zero(3, b.mesh.n_nodes());
  for (int i = 0; i < b.mesh.n_nodes(); ++i) {
    const double x = b.mesh.nodes(0, i), y = b.mesh.nodes(1, i), ring = std::max(x, y);
    const double angle = ring == 0.0 ? 0.0 : x >= y ? 0.25 * kPi * y / ring : 0.5 * kPi - 0.25 * kPi * x / ring;
    b.mesh.nodes.col(i).head<2>() = ring / n * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    for (const bool held : {x == 0.0, y == 0.0, true}) b.held.push_back(held);
    b.open.push_back(ring > n - 0.5);
    if (b.mesh.nodes(2, i) > 0.5 / n) b.motion(2, i) = -1.0 / n;  // strain 1
  }
  return b;
}

TEST(PoreFlow, UnconfinedCylinderRelaxesAsArmstrongLaiAndMow) {
  const FemMaterial tissue{3e3, 0.48, 1000.0};
  const Drainage d{1e-3, 0.15};
  const double nu = d.poisson_drained;
  const auto [G, M, Q] = moduli(tissue, d);
  const PoreLaw law = pore_law(tissue, d, "test");
  double before = 0.0;
  for (const int n : {6, 12}) {
    const DrainingForce f = draining_force(disc(n, tissue, d));
    const double volume = 0.25 * kPi / n, E = law.drained.young;
    EXPECT_NEAR(f.rest / (volume * E), 1.0, 0.02);
    double worst = 0.0;
    for (const double T : {0.02, 0.05, 0.1, 0.3}) {
      double sum = E;
      for (int k = 1; k <= 40; ++k) {
        const auto J0 = [](double x) { return std::cyl_bessel_j(0.0, x); };
        const auto J1 = [](double x) { return std::cyl_bessel_j(1.0, x); };
        const double a = root([&, G = G, M = M, Q = Q](double x) { return (1 / Q + 1 / M) * J0(x) - G * (2 * J1(x) / x - J0(x)) / (M * (M - G)); }, k == 1 ? 0.5 : (k - 0.75) * kPi - 0.5, (k - 0.25) * kPi + 0.2);
        const double mean = 2 * J1(a) / a - J0(a), pp = J0(a) * J0(a) + J1(a) * J1(a) - 4 * J0(a) * J1(a) / a + J0(a) * J0(a);
        sum += std::pow((1 - 2 * nu) * mean, 2) / ((1 / Q + 1 / M) * pp + G / (M * (M - G)) * mean * mean) * std::exp(-a * a * T);
      }
      worst = std::max(worst, std::abs(left_after(f, T / d.diffusivity) / (volume * sum) - 1.0));
    }
    std::printf("unconfined cylinder, %d rings: largest error %.2e, sudden over drained %.4f (%.4f)\n", n, worst, f.sudden() / f.rest, tissue.young / E);
    EXPECT_LT(worst, n == 6 ? 0.03 : 0.01);
    if (n == 12) {
      EXPECT_LT(worst, 0.4 * before);
    }
    before = worst;
  }
}

TEST(PoreFlow, StepsOfASceneDrainAsTheModesDo) {
  // the column again by PoreFlow's explicit content and LinearFem's equilibria: the same force within the step's error
  const FemMaterial tissue{3e3, 0.45, 1000.0};
  const Drainage d{1e-3, 0.1};
  const int n = 10;
  const DrainingBody b = column(n, tissue, d);
  FemOptions o;
  o.averaged_pressure = true;
  o.solver.relative = 1e-9;
  o.solver.max_iterations = 4000;
  LinearFem fem(b.mesh, {tissue}, o);
  PoreFlow flow(b.mesh, {tissue}, d, "test");
  std::vector<MovedNode> moved;
  for (int i = 0; i < b.mesh.n_nodes(); ++i) {
    MovedNode m;
    m.node = i;
    m.target = 0.01 * b.motion.col(i);
    m.prescribed = b.held[3 * static_cast<std::size_t>(i) + 2] != 0;
    m.stiffness = Vec3(1e7, 1e7, 0.0).asDiagonal();
    moved.push_back(m);
  }
  FemState s = fem.rest();
  Eigen::VectorXd content = Eigen::VectorXd::Zero(b.mesh.n_nodes());
  const DrainingForce f = draining_force(b);
  const double dt = 0.1;
  Points loads = Points::Zero(3, b.mesh.n_nodes());
  for (int k = 0; k <= 1000; ++k) {
    ASSERT_TRUE(fem.equilibrium(s, moved, &loads).sound);
    double force = 0.0;
    for (const MovedNode& m : moved)
      if (m.prescribed && m.target.z() != 0.0) force -= m.force.z();
    if (k == 100 || k == 300 || k == 1000) {
      EXPECT_NEAR(force / (0.01 * left_after(f, k * dt)), 1.0, 0.01) << k * dt << " s";
    }
    loads.setZero();
    flow.step(s.u, b.open, dt, content, loads);
  }
}

TEST(PoreFlow, ValuesThatMakeNoTissueAreRefused) {
  EXPECT_THROW(pore_law({3e3, 0.45, 1000.0}, {1e-9, 0.46}, "f"), InputError);
  EXPECT_THROW(pore_law({3e3, 0.45, 1000.0}, {1e-9, -1.0}, "f"), InputError);
  EXPECT_THROW(pore_law({3e3, 0.45, 1000.0}, {0.0, 0.2}, "f"), InputError);
  EXPECT_NEAR(poisson_by_block(0.3, 0.5), 0.05, 1e-12);
  EXPECT_NEAR(poisson_by_punch(0.3, 0.5), 1.0 - 0.5 / 0.7, 1e-12);
}

}  // namespace pore_flow_test
}  // namespace filum
