#include "training/knot_closure.h"

#include <gtest/gtest.h>

#include "tests/training/knot_shapes.h"

namespace filum {
namespace knot_closure_test {

using namespace shapes;

TEST(KnotClosure, LeadsTailsAwayFromTheThread) {
  Points line(3, 11);
  for (int k = 0; k <= 10; ++k) line.col(k) = Vec3(1e-3 * k, 0, 0);
  const Closure c = free_closures(line, 1).front();
  EXPECT_LT(c.first.x(), -0.9);
  EXPECT_GT(c.last.x(), 0.9);
}

TEST(KnotClosure, OffersDirectionsWellApart) {
  const std::vector<Closure> closures = free_closures(throws_round_post({3, -3}), 5);
  ASSERT_EQ(closures.size(), 5u);
  for (std::size_t i = 0; i < closures.size(); ++i) {
    EXPECT_NEAR(closures[i].first.norm(), 1.0, 1e-12);
    for (std::size_t j = i + 1; j < closures.size(); ++j) {
      const bool apart =
          closures[i].first.dot(closures[j].first) < 0.77 || closures[i].last.dot(closures[j].last) < 0.77;
      EXPECT_TRUE(apart) << i << " " << j;
    }
  }
}

TEST(KnotClosure, TheWayRoundStaysOutsideTheThread) {
  const Points thread = throws_round_post({3, -3});
  const Vec3 centre = 0.5 * (thread.rowwise().minCoeff() + thread.rowwise().maxCoeff());
  const double reach = (thread.colwise() - centre).colwise().norm().maxCoeff();
  Rng rng(7);
  for (int k = 0; k < 1000; ++k) {
    const Vec3 d = rng.direction();
    // Also ways out that are opposite to each other, where the straight way would lead through the thread.
    const Closure closure{d, k % 2 == 0 ? rng.direction() : Vec3(-d)};
    const Points closed = close_curve(thread, closure);
    ASSERT_EQ(closed.cols(), thread.cols() + 3);
    for (Eigen::Index e = thread.cols(); e + 1 < closed.cols(); ++e) {
      const Vec3 p = closed.col(e), u = closed.col(e + 1) - p;
      const double t = std::clamp((centre - p).dot(u) / u.squaredNorm(), 0.0, 1.0);
      EXPECT_GT((p + t * u - centre).norm(), 1.5 * reach);
    }
  }
}

}  // namespace knot_closure_test
}  // namespace filum
