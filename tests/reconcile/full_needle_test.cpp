// The trainer's needle in a track against the reduced law: a spring to the puncture, friction of the length inside, a ramp before each further layer.

#include <gtest/gtest.h>

#include <cmath>

#include "reconcile/full_solver.h"

namespace filum::reconcile {
namespace full_needle_test {

/// In to 10 mm, rest, and out, 300 samples.
NeedlePath path() {
  NeedlePath p;
  p.deepest = 10e-3;
  p.stiffness = 60.0;
  p.puncture = 60.0 * 3e-3;
  for (int i = 0; i < 300; ++i) {
    const double x = i / 299.0;
    p.depth.push_back(10e-3 * (x < 0.4 ? x / 0.4 : x < 0.6 ? 1.0 : (1.0 - x) / 0.4));
  }
  return p;
}

TEST(FullNeedle, SpringToThePunctureThenNothing) {
  const NeedlePath p = path();
  const auto f = needle_forces(p, 4e-6);
  for (std::size_t i = 0; i < f.size(); ++i) {
    const double x = p.depth[i];
    const bool before = i < 120 && x < 2.85e-3;
    if (before || x > 3.3e-3 || i > 120) {
      EXPECT_NEAR(f[i], before ? 60.0 * x : 0.0, 0.03 * p.puncture) << i;
    }
  }
}

TEST(FullNeedle, FrictionOfTheLengthInsideBothWays) {
  NeedlePath p = path();
  p.friction = 8.0;
  // one of the track's knots stands for a tenth of the way; soft tissue lets the point give a little at each, which adds up to a tenth
  const double knot = 8.0 * 0.1 * p.deepest;
  double mean = 0.0;
  int n = 0;
  const auto f = needle_forces(p, 4e-6);
  for (std::size_t i = 0; i < f.size(); ++i) {
    const double x = p.depth[i], law = 8.0 * x;
    if (i < 118 && x > 4e-3) {
      EXPECT_NEAR(f[i], law, knot + 0.1 * law) << i;
    }
    if (i > 190 && x > 4e-3) {
      EXPECT_NEAR(f[i], -law, knot + 0.1 * law) << i;
      mean += f[i] / law, ++n;
    }
  }
  EXPECT_NEAR(mean / n, -1.0, 0.1);
}

TEST(FullNeedle, ASecondLayerGivesWayAtItsForce) {
  NeedlePath p = path();
  p.ruptures = {{5e-3, 60.0 * 1.5e-3}};
  const auto f = needle_forces(p, 4e-6);
  double most = 0.0;
  for (std::size_t i = 0; i < 120; ++i) {
    const double x = p.depth[i];
    if (x > 3.5e-3) most = std::max(most, f[i]);
    if (x > 5.1e-3 && x < 6.3e-3) {
      EXPECT_NEAR(f[i], 60.0 * (x - 5e-3), 0.04 * p.puncture) << i;
    }
    if (x > 6.9e-3) {
      EXPECT_NEAR(f[i], 0.0, 0.03 * p.puncture) << i;
    }
  }
  EXPECT_NEAR(most, 60.0 * 1.5e-3, 0.06 * p.puncture);
}

/// Friction of the length beyond where it pierced only, and friction that is felt before it pierces, where it is a stiffer spring.
TEST(FullNeedle, OtherFormsOfFriction) {
  NeedlePath beyond = path(), before = path();
  beyond.friction = before.friction = 8.0;
  beyond.friction_from = 3e-3;
  before.touch = before.stiffness + before.friction;
  before.puncture = before.touch * 3e-3;
  const double knot = 8.0 * 0.1 * beyond.deepest;
  const auto f = needle_forces(beyond, 4e-6), g = needle_forces(before, 4e-6);
  for (std::size_t i = 0; i < f.size(); ++i) {
    const double x = beyond.depth[i], sign = i < 120 ? 1.0 : -1.0, law = sign * 8.0 * std::max(0.0, x - 3e-3);
    if (i < 118 && x < 2.85e-3) {
      EXPECT_NEAR(f[i], 60.0 * x, 0.03 * beyond.puncture) << i;
      EXPECT_NEAR(g[i], 68.0 * x, 0.03 * before.puncture) << i;
    }
    if ((i < 118 || i > 190) && x > 4e-3) {
      EXPECT_NEAR(f[i], law, knot + 0.8 * x) << i;
      EXPECT_NEAR(g[i], sign * 8.0 * x, knot + 0.8 * x) << i;
    }
  }
}

/// A layer softer than the tissue: its ramp begins at its face and is as steep as it is.
TEST(FullNeedle, ALayerHasItsOwnStiffness) {
  NeedlePath p = path();
  p.ruptures = {{4e-3, 60.0 * 1.5e-3, 30.0}};
  const auto f = needle_forces(p, 4e-6);
  double broke = 0.0;
  for (std::size_t i = 1; i < 120; ++i) {
    const double x = p.depth[i];
    if (x > 4.1e-3 && x < 6.8e-3) {
      EXPECT_NEAR(f[i], 30.0 * (x - 4e-3), 0.04 * p.puncture) << i;
    }
    if (x > 5e-3 && f[i - 1] - f[i] > 0.5 * 60.0 * 1.5e-3) broke = x;
  }
  EXPECT_NEAR(broke, 7e-3, 0.15e-3);  // found by the simulation: 1.5 mm x 60 N/m over 30 N/m below the face
}

}  // namespace full_needle_test
}  // namespace filum::reconcile
