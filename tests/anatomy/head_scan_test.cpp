#include "anatomy/head_scan.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "anatomy/scans.h"
#include "base/error.h"

namespace filum {
namespace head_scan_test {

Volume ball() {
  constexpr int n = 72;
  constexpr double voxel = 2e-3;
  Volume v;
  v.size = {n, n, n};
  const auto bytes = scans::ball_head(n, 1e3 * voxel);
  v.value.assign(bytes.begin(), bytes.end());
  v.step = voxel * Mat3::Identity();
  v.first = Vec3::Constant(-0.5 * voxel * (n - 1));
  return v;
}

TEST(HeadScan, OtsuPartsTwoHeaps) {
  std::vector<float> value;
  for (int k = 0; k < 1000; ++k) value.push_back(static_cast<float>(k % 2 == 0 ? 10 + k % 7 : 100 + k % 9));
  EXPECT_GT(otsu(value), 16.0);
  EXPECT_LT(otsu(value), 100.0);
}

TEST(HeadScan, TheBrainOfABallHeadIsFoundWithinItsScalp) {
  const BrainScan b = find_brain(ball(), {}, "ball");
  const double volume = 4.0 / 3.0 * std::numbers::pi * std::pow(45e-3, 3);
  EXPECT_NEAR(b.volume, volume, 0.03 * volume);
  EXPECT_LT(b.middle.norm(), 1e-4);
  EXPECT_NEAR(b.means[0], 60.0, 5.0);
  EXPECT_NEAR(b.means[1], 130.0, 5.0);
  EXPECT_NEAR(b.means[2], 200.0, 5.0);
  const auto share = [&](const std::vector<float>& of, double x) { return sample(b.grid, of, (Vec3(x, 0, 0) - b.grid.first) / 2e-3); };
  EXPECT_GT(share(b.brain, 43e-3), 0.5);
  EXPECT_LT(share(b.brain, 47e-3), 0.5);
  EXPECT_GT(share(b.white, 28e-3), 0.5);
  EXPECT_LT(share(b.white, 32e-3), 0.5);
  EXPECT_GT(share(b.brain, 0.0), 0.99);  // fluid within belongs to it
}

TEST(HeadScan, AnEmptyScanIsRefused) {
  Volume v = ball();
  std::fill(v.value.begin(), v.value.end(), 7.0f);
  EXPECT_THROW(find_brain(v, {}, "empty"), InputError);
}

}  // namespace head_scan_test
}  // namespace filum
