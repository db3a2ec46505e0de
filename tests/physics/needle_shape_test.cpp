#include "physics/needle_shape.h"

#include <gtest/gtest.h>

namespace filum {
namespace needle_shape_test {

NeedleShape half_circle() {
  NeedleShape n;
  n.circle = 0.5;
  n.bend_radius = 2e-3;
  return n;
}

TEST(NeedleShape, CentreOfMassIsTheOrigin) {
  for (const double circle : {0.25, 0.375, 0.5}) {
    NeedleShape n;
    n.circle = circle;
    Vec3 mean = Vec3::Zero();
    constexpr int kParts = 4000;
    for (int k = 0; k < kParts; ++k) mean += n.point(n.length() * (k + 0.5) / kParts) / kParts;
    EXPECT_LT(mean.norm(), 1e-6 * n.bend_radius) << circle;
  }
}

TEST(NeedleShape, InertiaIsThatOfTheWire) {
  for (const double circle : {0.25, 0.375, 0.5}) {
    NeedleShape n;
    n.circle = circle;
    Vec3 sum = Vec3::Zero();
    constexpr int kParts = 4000;
    for (int k = 0; k < kParts; ++k) {
      const Vec3 p = n.point(n.length() * (k + 0.5) / kParts);
      sum += n.mass() / kParts * Vec3(p.y() * p.y() + p.z() * p.z(), p.x() * p.x() + p.z() * p.z(), p.x() * p.x() + p.y() * p.y());
    }
    EXPECT_LT((sum - n.inertia()).norm(), 1e-6 * sum.norm()) << circle;
  }
}

TEST(NeedleShape, TangentIsTheDerivativeAndLengthsAgree) {
  const NeedleShape n = half_circle();
  constexpr double kStep = 1e-9;
  for (const double share : {0.1, 0.5, 0.9}) {
    const double a = share * n.length();
    const Vec3 d = (n.point(a + kStep) - n.point(a - kStep)) / (2.0 * kStep);
    EXPECT_LT((d - n.tangent(a)).norm(), 1e-5);
  }
  EXPECT_NEAR(n.chord(), 2.0 * n.bend_radius, 1e-12);
  EXPECT_NEAR((n.point(0.0) - n.point(n.length())).norm(), n.chord(), 1e-12);
  EXPECT_GT(n.tangent(0.5 * n.length()).y(), 0.999);  // from the swage to the point is towards +y
}

TEST(NeedleShape, WeighsWhatSteelWeighs) {
  NeedleShape n;  // 75 um wire, 3.8 mm long: 0.13 mg
  EXPECT_NEAR(n.mass(), 7900.0 * 3.14159265 * 37.5e-6 * 37.5e-6 * 3.77e-3, 1e-9);
}

}  // namespace needle_shape_test
}  // namespace filum
