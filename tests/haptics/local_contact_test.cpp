#include "haptics/local_contact.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "haptics/hand_coupling.h"

namespace filum {
namespace local_contact_test {

/// A tool at the world's rate: hung on the hand by 500 N/m, pressed against a plane of stiffness `wall` at z = 0 from above.
/// Quasi-static: k_c (p_D - p_T) + K (0 - p_T) = 0 below the plane.
struct Scene {
  double wall, coupling = 500.0;
  double tip(double hand) const { return hand >= 0.0 ? hand : coupling / (coupling + wall) * hand; }
  double force(double hand) const { return hand >= 0.0 ? 0.0 : -wall * tip(hand); }
};

TEST(LocalContact, FindsTheStiffnessOfWhatIsTouched) {
  for (const double wall : {50.0, 400.0, 2000.0}) {
    const Scene scene{wall};
    LocalContact contact;
    for (int k = 0; k < 300; ++k) {
      const double hand = -2e-6 * k;  // 1 mm/s at 500 Hz
      contact.update(Vec3(0, 0, scene.tip(hand)), Vec3(0, 0, -1e-3), Vec3(0, 0, scene.force(hand)), Vec3(0, 0, hand), 2000 * k);
    }
    EXPECT_TRUE(contact.touching());
    EXPECT_NEAR(contact.stiffness(), wall, 0.02 * wall);
    EXPECT_NEAR(contact.normal().z(), 1.0, 1e-12);
    // Between steps the tip is where the two springs put it.
    const double hand = -2e-6 * 299.5;
    EXPECT_NEAR(contact.tip(Vec3(0, 0, hand), 2000 * 299 + 1000).z(), scene.tip(hand), 1e-8);
  }
}

/// Largest change of force in a millisecond of a slow press of 1 mm/s, with the world at 500 Hz and one step late.
double largest_step(bool local, double wall) {
  const Scene scene{wall};
  LocalContact contact;
  HandCoupling coupling;
  double before = 0.0, most = 0.0, held = 0.0;
  bool known = false;
  for (int ms = 0; ms < 1000; ++ms) {
    const double hand = 50e-6 - 1e-6 * ms;
    if (ms % 2 == 0) {
      const double then = hand + 2e-6;  // the world answers to where the hand was a step ago
      held = scene.tip(then);
      const Vec3 v(0, 0, then < 0.0 ? -1e-3 * scene.coupling / (scene.coupling + wall) : -1e-3);
      contact.update(Vec3(0, 0, held), v, Vec3(0, 0, scene.force(then)), Vec3(0, 0, hand), 1000 * ms);
      known = true;
    }
    const Vec3 p_D(0, 0, hand);
    const Vec3 tip = local && known ? contact.tip(p_D, 1000 * ms) : Vec3(0, 0, held);
    const double force = coupling.force(p_D, tip, Vec3::Zero(), 1e-3).z();
    if (ms > 2) most = std::max(most, std::abs(force - before));
    before = force;
  }
  return most;
}

TEST(LocalContact, ASlowPressHasNoStepsAboveTwoMillinewton) {
  for (const double wall : {100.0, 500.0, 1000.0, 3000.0}) {
    const double with = largest_step(true, wall), without = largest_step(false, wall);
    std::printf("wall %4.0f N/m: largest step %.3f mN in a millisecond, %.3f mN without the local model\n", wall, 1e3 * with, 1e3 * without);
    EXPECT_LT(with, 2e-3) << wall;
  }
}

TEST(LocalContact, WithoutContactTheTipGoesOnAsItWent) {
  LocalContact contact;
  contact.update(Vec3(1e-3, 0, 0), Vec3(0.01, 0, 0), Vec3::Zero(), Vec3(1e-3, 0, 0), 0);
  EXPECT_NEAR(contact.tip(Vec3(5e-3, 0, 0), 1000).x(), 1.01e-3, 1e-12);
  EXPECT_NEAR(contact.tip(Vec3(5e-3, 0, 0), 1'000'000).x(), 1.04e-3, 1e-12) << "for two steps at most";
}

TEST(LocalContact, AJumpOfTheWorldFadesOverOneStep) {
  LocalContact contact;
  contact.update(Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), 0);
  contact.update(Vec3(1e-5, 0, 0), Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), 2000);
  EXPECT_NEAR(contact.tip(Vec3::Zero(), 2000).x(), 0.0, 1e-15);
  EXPECT_NEAR(contact.tip(Vec3::Zero(), 3000).x(), 0.5e-5, 1e-15);
  EXPECT_NEAR(contact.tip(Vec3::Zero(), 4000).x(), 1e-5, 1e-15);
}

TEST(LocalContact, AcrossTheNormalTheTipFollowsTheHand) {
  LocalContact contact;
  contact.update(Vec3::Zero(), Vec3::Zero(), Vec3(0, 0, 0.1), Vec3::Zero(), 0);
  const Vec3 tip = contact.tip(Vec3(1e-4, 0, -1e-4), 2000);
  EXPECT_NEAR(tip.x(), 1e-4, 1e-15);
  EXPECT_NEAR(tip.z(), -0.5e-4, 1e-15) << "as stiff as the coupling until more is known";
}

}  // namespace local_contact_test
}  // namespace filum
