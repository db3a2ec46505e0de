#include "physics/vessel_clamp.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

using namespace filum;

namespace {

TEST(VesselClamp, CutEdgesFaceEachOtherAcrossTheGap) {
  TubeShape shape;
  DoubleClamp c;
  c.X_WB = {Vec3(0.01, 0.02, 0.03), Quat(Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitY()))};
  c.gap = 0.3e-3;
  const VesselMesh m = make_stumps(shape, c);
  ASSERT_EQ(m.edge_ring.size(), 2u);
  for (int part = 0; part < 2; ++part)
    for (const int i : m.edge_ring[static_cast<std::size_t>(part)]) {
      const Vec3 p_B = c.X_WB.inverse() * Vec3(m.nodes.col(i));
      EXPECT_NEAR(p_B.z(), part == 0 ? -0.15e-3 : 0.15e-3, 1e-12);
    }
}

TEST(VesselClamp, TurnedOverTheBackWallIsInFront) {
  DoubleClamp first, now;
  now.turn = std::numbers::pi;
  now.gap = first.gap - 0.1e-3;
  const auto motion = clamp_motion(first, now, 3e-3);
  const Vec3 back(0, -0.4e-3, -1e-3), moved = motion[0] * back;
  EXPECT_NEAR(moved.y(), 0.4e-3, 1e-12);
  EXPECT_NEAR(moved.z(), -1e-3 + 0.05e-3, 1e-12);
  EXPECT_NEAR((motion[1] * Vec3(0, 0.4e-3, 1e-3)).z(), 1e-3 - 0.05e-3, 1e-12);
}

TEST(VesselClamp, MovesNoFasterThanItMay) {
  DoubleClamp c;
  c = approach(c, 0.0, 3.0, 2e-3, 5e-3, 2.0);
  EXPECT_NEAR(c.gap, 0.2e-3 - 1e-5, 1e-12);
  EXPECT_NEAR(c.turn, 4e-3, 1e-12);
  for (int k = 0; k < 2000; ++k) c = approach(c, 0.0, 3.0, 2e-3, 5e-3, 2.0);
  EXPECT_NEAR(c.gap, 0.0, 1e-15);
  EXPECT_NEAR(c.turn, 3.0, 1e-12);
}

}  // namespace
