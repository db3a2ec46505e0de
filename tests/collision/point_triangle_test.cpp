#include "collision/point_triangle.h"

#include <gtest/gtest.h>

#include "base/rng.h"

namespace filum {
namespace point_triangle_test {

TEST(PointTriangle, NoPointOfAGridOnTheTriangleIsNearer) {
  Rng rng(11);
  const auto random_point = [&] { return Vec3(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1)); };
  for (int trial = 0; trial < 300; ++trial) {
    const Vec3 a = random_point(), b = random_point(), c = random_point(), q = 2.0 * random_point();
    const TrianglePoint found = closest_on_triangle(q, a, b, c);
    EXPECT_NEAR(found.weights.sum(), 1.0, 1e-9);
    EXPECT_GE(found.weights.minCoeff(), -1e-9);
    const double distance = (found.point - q).norm();
    double nearest = 1e9;
    const int n = 60;
    for (int i = 0; i <= n; ++i)
      for (int j = 0; i + j <= n; ++j) nearest = std::min(nearest, ((i * a + j * b + (n - i - j) * c) / n - q).norm());
    EXPECT_LE(distance, nearest + 1e-9);
    EXPECT_GT(distance, nearest - 0.06);
  }
}

TEST(PointTriangle, CornersSidesAndFaceAreTold) {
  const Vec3 a(0, 0, 0), b(1, 0, 0), c(0, 1, 0);
  EXPECT_EQ(closest_on_triangle(Vec3(-1, -1, 2), a, b, c).weights, Vec3(1, 0, 0));
  EXPECT_EQ(closest_on_triangle(Vec3(0.5, -1, 2), a, b, c).weights, Vec3(0.5, 0.5, 0));
  EXPECT_LT((closest_on_triangle(Vec3(0.25, 0.25, 7), a, b, c).point - Vec3(0.25, 0.25, 0)).norm(), 1e-15);
}

}  // namespace point_triangle_test
}  // namespace filum
