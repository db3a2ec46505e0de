#include "devices/hand_tremor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "devices/pose_script.h"

namespace filum {
namespace hand_tremor_test {

TEST(HandTremor, HasTheRmsAndTheBandItSays) {
  const HandTremor tremor(60e-6, 9.0, 2.0);
  double square = 0.0, slow = 0.0;
  Vec3 sum = Vec3::Zero();
  constexpr int n = 200'000;
  for (int k = 0; k < n; ++k) {
    const Vec3 d = tremor.at(1e-3 * k);
    square += d.squaredNorm() / n;
    sum += d;
    if (k % 1000 == 999) slow += (sum / 1000.0).squaredNorm() * 1000.0 / n, sum.setZero();  // means over 1 s
  }
  EXPECT_NEAR(std::sqrt(square), 60e-6, 1e-6);
  EXPECT_LT(std::sqrt(slow), 3e-6) << "little below 1 Hz";
}

TEST(HandTremor, AScriptMayHaveOneAndIsTheSameEachTime) {
  const std::string text =
      "format: filum-demonstration/1\ntitle: t\ntools:\n  - tool: 0\n    tremor: { rms: 60 um, frequency: 9 Hz, width: 2 Hz }\n"
      "    keys:\n      - { t: 0 s, p: [0 mm, 0 mm, 5 mm], handle: [0, 0, 1], opening: [1, 0, 0], grip: 3 deg }\n"
      "      - { t: 9 s, stop: true }\n";
  const PoseScript a = PoseScript::parse(text, "a.yaml"), b = PoseScript::parse(text, "b.yaml");
  double most = 0.0;
  for (int k = 0; k < 9000; ++k) {
    const Vec3 p = a.at(0, 1e-3 * k).X_WD.p;
    ASSERT_EQ(p, b.at(0, 1e-3 * k).X_WD.p);
    most = std::max(most, (p - Vec3(0, 0, 5e-3)).norm());
  }
  EXPECT_GT(most, 80e-6);
  EXPECT_LT(most, 300e-6);
}

}  // namespace hand_tremor_test
}  // namespace filum
