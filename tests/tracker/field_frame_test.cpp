#include "tracker/field_frame.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "base/error.h"

namespace filum {
namespace field_frame_test {

Pose table() {
  Pose X;
  X.p = Vec3(0.01, -0.02, 0.3);
  X.q = Quat(Eigen::AngleAxisd(2.6, Vec3(1, 0.1, 0).normalized()));
  return X;
}

class Noise {
 public:
  Pose on(const Pose& X, double metres, double radians) {
    const Vec3 w(normal_(random_), normal_(random_), normal_(random_));
    return {X.p + metres * Vec3(normal_(random_), normal_(random_), normal_(random_)), X.q * Quat(Eigen::AngleAxisd(radians * w.norm(), w.normalized()))};
  }

 private:
  std::mt19937 random_{4};
  std::normal_distribution<double> normal_;
};

TEST(FieldFrame, IsTheMeanOfTheFirstSightings) {
  FieldFrame field;
  Noise noise;
  for (int k = 0; k < FieldFrame::kSightings; ++k) {
    EXPECT_FALSE(field.X_WC());
    Pose seen = noise.on(table(), 2e-4, 2e-3);
    if (k % 2) seen.q.coeffs() *= -1.0;  // the same rotation
    field.take(seen);
  }
  ASSERT_TRUE(field.X_WC());
  const Pose off = *field.X_WC() * table();
  EXPECT_LT(off.p.norm(), 4.0 * 2e-4 / std::sqrt(20.0) + 0.3 * 2e-3);
  EXPECT_LT(off.q.angularDistance(Quat::Identity()), 4.0 * 2e-3 / std::sqrt(20.0));
  EXPECT_NEAR(field.spread(), 2e-4 * std::sqrt(3.0), 1.5e-4);
}

TEST(FieldFrame, IsGivenUpWhenTheCameraWasMoved) {
  FieldFrame field;
  for (int k = 0; k < FieldFrame::kSightings; ++k) field.take(table());
  Pose moved = table();
  moved.p.x() += 5e-3;
  field.take(moved);
  EXPECT_TRUE(field.X_WC()) << "one bad sighting is none";
  field.take(table());
  for (int k = 0; k < FieldFrame::kBelieveAfter; ++k) field.take(moved);
  EXPECT_FALSE(field.X_WC());
  EXPECT_EQ(field.times_lost(), 1);
  for (int k = 0; k < FieldFrame::kSightings; ++k) field.take(moved);
  ASSERT_TRUE(field.X_WC());
  EXPECT_LT((*field.X_WC() * moved).p.norm(), 1e-12);
}

std::vector<Pose> turned_about(const Vec3& tip, const Vec3& hollow, double angle, bool second_axis, Noise& noise) {
  std::vector<Pose> poses;
  for (int k = 0; k < 60; ++k) {
    Pose X;
    X.q = Quat(Eigen::AngleAxisd(angle * std::sin(0.3 * k), Vec3::UnitX())) * Quat(Eigen::AngleAxisd(second_axis ? angle * std::cos(0.17 * k) : 0.0, Vec3::UnitY()));
    X.p = hollow - X.q * tip;
    poses.push_back(noise.on(X, 2e-4, 2e-3));
  }
  return poses;
}

TEST(Pivot, TheTipThatStaysIsFound) {
  Noise noise;
  const Vec3 tip(1e-3, -2e-3, -0.09);
  const Pivot p = pivot_of(turned_about(tip, {0.02, 0.01, 0.3}, 0.5, true, noise));
  EXPECT_LT((p.tip - tip).norm(), 5e-4);
  EXPECT_NEAR(p.residual, std::sqrt(3.0 * 2e-4 * 2e-4 + 2.0 * std::pow(0.09 * 2e-3, 2)), 1.5e-4);
  EXPECT_GT(p.turned, 0.8);
}

TEST(Pivot, RefusesWhatDoesNotTellIt) {
  Noise noise;
  const Vec3 tip(0, 0, -0.09), hollow(0.02, 0.01, 0.3);
  EXPECT_THROW(pivot_of({}), InputError);
  EXPECT_THROW(pivot_of(turned_about(tip, hollow, 0.1, true, noise)), InputError) << "hardly turned";
  std::vector<Pose> slipping = turned_about(tip, hollow, 0.5, true, noise);
  for (std::size_t k = 0; k < slipping.size(); ++k) slipping[k].p.x() += 1e-3 * static_cast<double>(k % 20);
  EXPECT_THROW(pivot_of(slipping), InputError) << "the tip has left its hollow";
}

}  // namespace field_frame_test
}  // namespace filum
