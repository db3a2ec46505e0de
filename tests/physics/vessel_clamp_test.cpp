#include "physics/vessel_clamp.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

using namespace filum;

namespace vessel_clamp_test {

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

TEST(VesselClamp, EndToSideTheBevelLiesOnTheOpening) {
  TubeShape vessel, stump;
  vessel.around = stump.around = 20;
  vessel.along = 24;
  DoubleClamp c;
  c.X_WB = {Vec3(0.01, 0.02, 0.03), Quat(Eigen::AngleAxisd(1.0, Vec3(1, 2, 3).normalized()))};
  c.gap = 0.3e-3;
  c.turn = 0.7;
  c.side = SideHold{0.7, 2.2e-3, 0.45e-3};
  const VesselMesh m = make_end_to_side(vessel, {}, stump, c);
  const Pose bar = c.X_WB * Pose{Vec3::Zero(), Quat(Eigen::AngleAxisd(c.turn, Vec3::UnitZ()))};
  const auto at = [&](int part, std::size_t k) { return Vec3(bar.inverse() * Vec3(m.nodes.col(m.edge_ring[static_cast<std::size_t>(part)][k]))); };
  EXPECT_NEAR((at(0, 0) - Vec3(0, 0.35e-3, 0.7e-3)).norm(), 0.0, 1e-9) << "the opening's end of greater z, on the inner face";
  EXPECT_NEAR((at(0, 14) - Vec3(0, 0.35e-3, -0.7e-3)).norm(), 0.0, 1e-9);
  for (std::size_t k = 0; k < 20; ++k) EXPECT_NEAR(at(1, k).y(), 0.75e-3, 1e-9) << "the bevel is parallel to the vessel, the gap above it";
  EXPECT_NEAR(at(1, 0).z(), -0.35e-3 / std::sin(0.7), 1e-9) << "the long lip is the toe";
  EXPECT_NEAR(at(1, 10).z(), 0.35e-3 / std::sin(0.7), 1e-9);
  DoubleClamp down = c;
  down.gap = 0.1e-3;
  const auto motion = clamp_motion(c, down, stump.length);
  EXPECT_NEAR((motion[0] * Vec3(1e-3, 2e-3, 3e-3) - Vec3(1e-3, 2e-3, 3e-3)).norm(), 0.0, 1e-12) << "the vessel stays";
  EXPECT_NEAR((bar.inverse() * (motion[1] * Vec3(m.nodes.col(m.edge_ring[1][0])))).y(), 0.55e-3, 1e-9);
  int ends[2] = {0, 0};
  for (const int i : m.held) ++ends[m.node_part[static_cast<std::size_t>(i)]];
  EXPECT_EQ(ends[0], 2 * ends[1]);
}

}  // namespace vessel_clamp_test
