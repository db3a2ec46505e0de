// The generator's reference solutions (CVODE) against closed forms, and the program's hereditary integrals against them.
#include "reconcile_generator/reference.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "reconcile/hereditary.h"

namespace filum::reconcile {
namespace reference_test {

TEST(Reference, RampThroughOneAndTwoLags) {
  const Eigen::VectorXd t = Eigen::VectorXd::LinSpaced(200, 0.0, 10.0);
  Eigen::VectorXd one(t.size()), two(t.size());
  ASSERT_EQ(filum_reference_lag(200, t.data(), t.data(), 1.5, 1, 1, one.data()), 0);
  ASSERT_EQ(filum_reference_lag(200, t.data(), t.data(), 1.5, 2, 1, two.data()), 0);
  for (Eigen::Index i = 0; i < t.size(); ++i) {
    const double s = 0.75;  // of each of two
    EXPECT_NEAR(one[i], t[i] - 1.5 * (1 - std::exp(-t[i] / 1.5)), 1e-7);
    EXPECT_NEAR(two[i], t[i] - 2 * s + (t[i] + 2 * s) * std::exp(-t[i] / s), 1e-7);
  }
}

TEST(Reference, BoucWenLoadsAsATanh) {
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(100, 0.0, 1.0);
  Eigen::VectorXd out(x.size());
  ASSERT_EQ(filum_reference_bouc_wen(100, x.data(), 0.2, out.data()), 0);
  for (Eigen::Index i = 0; i < x.size(); ++i) EXPECT_NEAR(x[i] - out[i], 0.1 * std::tanh(x[i] / 0.1), 1e-8);
}

TEST(Reference, LoadBorneByFluidDecaysAsTerzaghiSays) {
  const double D = 1e-7, size = 2e-3, half = 0.5 * size;
  const double rate = std::pow(0.5 * std::numbers::pi / half, 2) * D;  // of the slowest mode
  const Eigen::VectorXd t = Eigen::VectorXd::LinSpaced(400, 0.0, 5.0 / rate);
  const Eigen::VectorXd f = (t.array() * rate * 10).min(1.0).matrix();
  Eigen::VectorXd out(t.size());
  ASSERT_EQ(filum_reference_consolidation(400, t.data(), f.data(), 0.4, D, size, 0, out.data()), 0);
  const double a = out[240] - 0.6, b = out[320] - 0.6;
  EXPECT_NEAR(std::log(a / b) / (t[320] - t[240]) / rate, 1.0, 2e-4);
  // the program's series: the same
  Eigen::VectorXd series = f;
  relax(slab_drainage(0.4, D, size), t, series);
  EXPECT_LT((series - out).cwiseAbs().maxCoeff(), 5e-4);
}

TEST(Reference, WeaklyLoadedElasticaIsABeam) {
  double drop = 0, reach = 0;
  ASSERT_EQ(filum_reference_elastica(0.03, 1e-9, 1e-6, 0.0, 0.0, &drop, &reach), 0);
  EXPECT_NEAR(drop / (1e-6 * std::pow(0.03, 4) / 8e-9), 1.0, 1e-4);
  EXPECT_NEAR(reach, 0.03, 1e-6);
}

TEST(Reference, ThreadWithoutWeightIsItsNaturalShape) {
  // curvature k (1 - b s/L): theta = k L (x - b x^2/2), drop = L int sin theta
  const double L = 0.02, k = 40.0, taper = 0.5;
  double drop = 0, reach = 0, exact = 0;
  ASSERT_EQ(filum_reference_elastica(L, 1e-9, 1e-15, k, taper, &drop, &reach), 0);
  for (int i = 0; i < 2000; ++i) {
    const double x = (i + 0.5) / 2000;
    exact += L / 2000 * std::sin(k * L * (x - 0.5 * taper * x * x));
  }
  EXPECT_NEAR(drop / exact, 1.0, 1e-5);
}

TEST(Reference, ProgramsRelaxationSolvesTheSameEquation) {
  const Eigen::VectorXd t = Eigen::VectorXd::LinSpaced(300, 0.0, 60.0);
  const Eigen::VectorXd f = ((t.array() * 0.3).sin() + 0.2 * (t.array() * 0.9).sin().square()).matrix();
  Eigen::VectorXd q(t.size()), program = f;
  ASSERT_EQ(filum_reference_lag(300, t.data(), f.data(), 4.0, 1, 1, q.data()), 0);
  relax(prony(0.35, 4.0), t, program);
  EXPECT_LT((f - 0.35 * q - program).cwiseAbs().maxCoeff(), 1e-8);
}

}  // namespace reference_test
}  // namespace filum::reconcile
