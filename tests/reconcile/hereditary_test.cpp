#include "reconcile/hereditary.h"

#include <gtest/gtest.h>

#include <cmath>

namespace filum::reconcile {
namespace hereditary_test {

/// Ramp to 1 in `rise` seconds, then held.
Eigen::VectorXd ramp_and_hold(const Eigen::VectorXd& t, double rise) { return (t.array() / rise).min(1.0).matrix(); }

TEST(Hereditary, RampAndHoldFollowTheClosedForm) {
  const Eigen::VectorXd t = Eigen::VectorXd::LinSpaced(401, 0.0, 40.0);
  const double g = 0.4, tau = 5.0, rise = 2.0;
  Eigen::VectorXd f = ramp_and_hold(t, rise);
  relax(prony(g, tau), t, f);
  for (Eigen::Index i = 0; i < t.size(); ++i) {
    // int g(t-s) ds / rise over the ramp
    const double a = std::min(t[i], rise);
    const double expected = ((1 - g) * a + g * tau * (std::exp(-(t[i] - a) / tau) - std::exp(-t[i] / tau))) / rise;
    ASSERT_NEAR(f[i], expected, 1e-12) << t[i];
  }
}

TEST(Hereditary, CreepUndoesRelaxation) {
  const Eigen::VectorXd t = Eigen::VectorXd::LinSpaced(200, 0.0, 10.0);
  const Eigen::VectorXd f = (t.array() * 0.7).sin().matrix();
  Eigen::VectorXd g = f;
  const Kernel k = fractional(0.5, 1.0, 0.6);
  relax(k, t, g);
  EXPECT_GT((g - f).norm(), 0.1 * f.norm());
  creep(k, t, g);
  EXPECT_LT((g - f).norm(), 1e-10 * f.norm());
}

TEST(Hereditary, EveryKernelStartsAtOneAndFallsToItsRest) {
  for (const Kernel& k : {prony(0.3, 2.0), prony(0.3, 2.0, 0.2, 9.0), fractional(0.3, 2.0, 0.5), slab_drainage(0.3, 1e-8, 1e-3), radial_drainage(0.3, 1e-8, 1e-3)}) {
    double sum = k.rest;
    for (const double w : k.weight) sum += w;
    EXPECT_NEAR(sum, 1.0, 1e-12);
  }
}

TEST(Hereditary, DrainageSlowsWithTheSquareOfTheSize) {
  const Kernel small = slab_drainage(0.3, 1e-8, 1e-3), large = slab_drainage(0.3, 1e-8, 2e-3);
  for (std::size_t i = 0; i < small.tau.size(); ++i) EXPECT_NEAR(large.tau[i] / small.tau[i], 4.0, 1e-12);
}

}  // namespace hereditary_test
}  // namespace filum::reconcile
