#include "reconcile/transform.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace filum::reconcile {
namespace transform_test {

TEST(Transform, OnlyLongRecordsOfUnluckyLengthsLoseTheirLastSamples) {
  for (const int n : {64, 3750, 4447, 45000, 60000, 131072}) EXPECT_EQ(transformed_length(n), n) << n;  // 4447 is prime
  for (const int n : {59999, 1999993}) {                                                                // prime
    EXPECT_LT(transformed_length(n), n);
    EXPECT_GT(transformed_length(n), 0.97 * n);
  }
}

TEST(Transform, ASineStandsInItsOwnBin) {
  const int n = 59999;
  const auto used = static_cast<double>(transformed_length(n));
  Eigen::VectorXd v(n);
  for (Eigen::Index k = 0; k < n; ++k) v[k] = std::cos(2.0 * std::numbers::pi * 100.0 * static_cast<double>(k) / used);
  v[7] = NAN;  // missing
  const auto out = transform(v);
  ASSERT_EQ(static_cast<double>(out.size()), used);
  EXPECT_NEAR(std::abs(out[100]), 0.5 * used, 2.0);
  EXPECT_LT(std::abs(out[101]), 2.0);
}

}  // namespace transform_test
}  // namespace filum::reconcile
