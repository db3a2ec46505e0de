#include "physics/friction.h"

#include <gtest/gtest.h>

#include <random>

namespace filum {
namespace friction_test {

constexpr double kMu = 0.3, kNormal = 2.0, kStiffness = 1000.0;
const Vec3 kUp = Vec3::UnitZ();

/// A massless point under a steady tangential load, moved to equilibrium in every step while the bristle allows it.
Vec3 bristle_after(double load, int steps, double& travelled) {
  Vec3 xi = Vec3::Zero();
  travelled = 0.0;
  for (int k = 0; k < steps; ++k) {
    const FrictionPoint f = coulomb(xi, kUp, kNormal, kMu, kStiffness);
    const double du = (load + f.force.x()) / kStiffness;  // Newton step of the stick branch
    travelled += du;
    xi = f.xi + Vec3(du, 0, 0);
  }
  return xi;
}

TEST(Friction, SticksBelowTheLimitAndSlidesAtIt) {
  const double limit = kMu * kNormal;
  const FrictionPoint stick = coulomb(Vec3(0.99 * limit / kStiffness, 0, 0), kUp, kNormal, kMu, kStiffness);
  EXPECT_FALSE(stick.slipping);
  EXPECT_NEAR(stick.force.x(), -0.99 * limit, 1e-12);
  const FrictionPoint slip = coulomb(Vec3(3, 4, 0), kUp, kNormal, kMu, kStiffness);
  EXPECT_TRUE(slip.slipping);
  EXPECT_NEAR(slip.force.norm(), limit, 1e-12);
  EXPECT_NEAR(slip.force.normalized().dot(Vec3(3, 4, 0).normalized()), -1.0, 1e-12);
  EXPECT_NEAR(kStiffness * slip.xi.norm(), limit, 1e-12);
}

TEST(Friction, DoesNotCreepBelowTheLimitButMovesAbove) {
  double travelled = 0.0;
  const double load = 0.98 * kMu * kNormal;
  bristle_after(load, 10, travelled);
  const double soon = travelled;
  bristle_after(load, 100000, travelled);
  EXPECT_NEAR(travelled, soon, 1e-15);
  EXPECT_NEAR(travelled, load / kStiffness, 1e-15);
  bristle_after(1.02 * kMu * kNormal, 1000, travelled);
  EXPECT_GT(travelled, 10.0 * load / kStiffness);
}

TEST(Friction, ForceAndStiffnessAreDerivativesOfTheEnergy) {
  std::mt19937 gen(5);
  std::normal_distribution<double> normal;
  for (double size : {0.2, 0.9, 1.2, 8.0}) {  // of the stick range
    const double angle = normal(gen);
    const Vec3 xi = size * kMu * kNormal / kStiffness * Vec3(std::cos(angle), std::sin(angle), 0);
    const FrictionPoint f = coulomb(xi, kUp, kNormal, kMu, kStiffness);
    for (int axis = 0; axis < 2; ++axis) {
      const double h = 1e-9;
      const FrictionPoint up = coulomb(xi + h * Vec3::Unit(axis), kUp, kNormal, kMu, kStiffness);
      const FrictionPoint down = coulomb(xi - h * Vec3::Unit(axis), kUp, kNormal, kMu, kStiffness);
      EXPECT_NEAR((up.energy - down.energy) / (2 * h), -f.force[axis], 1e-6);
      EXPECT_NEAR((((up.force - down.force) / (2 * h)) + f.stiffness.col(axis)).norm(), 0.0, 1e-4 * kStiffness);
    }
  }
}

TEST(Friction, LightlyLoadedContactGivesByThePresliding) {
  EXPECT_DOUBLE_EQ(stick_stiffness(1e4, 0.2, 1e-6, 0.5e-6), 0.2 * 1e-6 / 0.5e-6);
  EXPECT_DOUBLE_EQ(stick_stiffness(1e4, 0.2, 10.0, 0.5e-6), 1e4);
}

}  // namespace friction_test
}  // namespace filum
