#include "base/pose.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/rng.h"

namespace filum {
namespace pose_test {

Pose random_pose(Rng& rng) {
  return {rng.direction() * rng.uniform(0.0, 0.1), rng.rotation()};
}

TEST(Pose, MapsPointsByRotationThenTranslation) {
  const Pose X_WT{Vec3(1, 2, 3), Quat(Eigen::AngleAxisd(std::acos(0.0), Vec3::UnitZ()))};
  EXPECT_TRUE((X_WT * Vec3(1, 0, 0)).isApprox(Vec3(1, 3, 3), 1e-15));
}

TEST(Pose, CompositionIsApplyingOneAfterTheOther) {
  Rng rng(3);
  for (int i = 0; i < 100; ++i) {
    const Pose a = random_pose(rng);
    const Pose b = random_pose(rng);
    const Vec3 p = rng.direction();
    EXPECT_TRUE(((a * b) * p).isApprox(a * (b * p), 1e-13));
  }
}

TEST(Pose, InverseUndoes) {
  Rng rng(4);
  for (int i = 0; i < 100; ++i) {
    const Pose a = random_pose(rng);
    const Vec3 p = rng.direction();
    EXPECT_TRUE((a.inverse() * (a * p)).isApprox(p, 1e-13));
    EXPECT_TRUE((a * (a.inverse() * p)).isApprox(p, 1e-13));
  }
}

TEST(Pose, FiniteSeesNaNInEitherPart) {
  Pose pose;
  EXPECT_TRUE(pose.finite());
  pose.p.y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(pose.finite());
  pose.p.y() = 0.0;
  pose.q.w() = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(pose.finite());
}

}  // namespace pose_test
}  // namespace filum
