// The trainer's rod drawn over a bar against Euler and Eytelwein.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "reconcile/full_solver.h"

namespace filum::reconcile {
namespace full_pull_test {

TEST(FullPull, LimpThreadFollowsEulerAtEveryAngle) {
  for (const double wrap : {0.5 * std::numbers::pi, std::numbers::pi, 2.0 * std::numbers::pi})
    for (const double mu : {0.125, 0.25}) {
      const double got = std::log(drawn_ratio(mu, wrap, 16)) / (mu * wrap);
      std::printf("mu %.3f wrap %.3f: exponent over Euler's %.4f (8 edges a radian: %.4f)\n", mu, wrap, got, std::log(drawn_ratio(mu, wrap, 8)) / (mu * wrap));
      EXPECT_NEAR(got, 1.0, 0.02) << mu << " " << wrap;
    }
}

}  // namespace full_pull_test
}  // namespace filum::reconcile
