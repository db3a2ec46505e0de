#include "training/stitch_guide.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "oblique_edges.h"
#include "training/task.h"

namespace filum {
namespace stitch_guide_test {

NeedleDescription needle() {
  NeedleDescription n;
  n.present = true;
  n.bend_radius = 1.2e-3;
  return n;
}

/// Two rings of 24 points on each stump, radius 0.5 mm, edges 0.2 mm from the middle.
TissueDescription vessel() {
  TissueDescription t;
  t.lumen = true;
  t.thickness = 0.1e-3;
  t.radius = 0.5e-3;
  t.axis = Vec3::UnitY();
  t.cut_along = Vec3::UnitZ();
  t.middle = Vec3(1e-3, 0, 2e-3);
  t.rest.resize(3, 4 * 24);
  for (int ring = 0; ring < 4; ++ring)
    for (int k = 0; k < 24; ++k) {
      const double a = std::numbers::pi * k / 12.0, y = (ring < 2 ? -1.0 : 1.0) * (ring % 2 == 0 ? 0.2e-3 : 0.4e-3);
      t.rest.col(24 * ring + k) = t.middle + Vec3(0.5e-3 * std::sin(a), y, 0.5e-3 * std::cos(a));
    }
  t.triangles.push_back({0, 1, 24});
  return t;
}

NeedleTask task(const std::string& name) { return *load_task(FILUM_SOURCE_DIR "/curricula/" + name + "/task.yaml").needle; }

TEST(StitchGuide, StandsTwoThicknessesFromBothEdgesRoundTheVessel) {
  const TissueDescription t = vessel();
  const auto guides = stitch_guides(t, needle(), task("anastomosis-8"));
  ASSERT_EQ(guides.size(), 8u);
  for (const StitchGuide& g : guides) {
    EXPECT_NEAR((g.in.at - t.middle).dot(t.axis), -0.4e-3, 1e-9);
    EXPECT_NEAR((g.out.at - t.middle).dot(t.axis), 0.4e-3, 1e-9);
    EXPECT_NEAR((g.in.at - t.rest.col(g.in.vertex)).norm(), 0.0, 1e-9);
    EXPECT_NEAR(((g.in.at - g.out.at) - (g.in.at - g.out.at).dot(t.axis) * t.axis).norm(), 0.0, 1e-9) << "not oblique";
  }
  EXPECT_NEAR((guides[0].in.at + guides[1].in.at - 2.0 * t.middle).dot(t.cut_along), 0.0, 1e-9) << "stays at 180 degrees";
}

TEST(StitchGuide, NeedleGoesInAtARightAngleAndDeepEnough) {
  const TissueDescription t = vessel();
  const StitchGuide g = stitch_guides(t, needle(), task("vessel-stitch"))[0];
  const Vec3 outward = Vec3::UnitZ();  // on top
  double least = 1.0, depth = 0.0;
  Vec3 direction = Vec3::Zero();
  for (std::size_t k = 0; k + 1 < g.in.path.size(); ++k) {
    const double height = (0.5 * (g.in.path[k] + g.in.path[k + 1]) - g.in.at).dot(outward);
    if (std::abs(height) < least) {
      least = std::abs(height);
      direction = (g.in.path[k + 1] - g.in.path[k]).normalized();
    }
    depth = std::min(depth, (g.in.path[k + 1] - g.in.at).dot(outward));
  }
  EXPECT_LT(direction.dot(outward), -0.998);
  EXPECT_NEAR(depth, -2.0 * t.thickness, 1e-9);
  EXPECT_GT((g.out.path.back() - g.out.at).dot(outward), 0.3e-3) << "the second comes out";
}

TEST(StitchGuide, RoundAnOpeningHeelAndToeFirst) {
  TissueDescription t = testing_shapes::oblique_edges();
  t.triangles.push_back({0, 1, 2});
  t.rest.resize(3, 2 * 400);
  for (int k = 0; k < 400; ++k) {  // a ring round each edge, 0.2 mm away on the surface
    const Vec3 p = t.edges[0].rim[static_cast<std::size_t>(k)], q = t.edges[1].rim[static_cast<std::size_t>(k)];
    t.rest.col(k) = p + 0.2e-3 * p.normalized() + 0.1e-3 * Vec3::UnitZ();
    t.rest.col(400 + k) = q - 0.2e-3 * t.edges[1].axis + 0.1e-3 * (q - t.edges[1].origin).normalized();
  }
  const auto guides = stitch_guides(t, needle(), task("end-to-side"));
  ASSERT_EQ(guides.size(), 8u);
  EXPECT_NEAR(guides[0].in.at.y(), 0.9e-3, 0.02e-3) << "the heel";
  EXPECT_NEAR(guides[1].in.at.y(), -0.9e-3, 0.02e-3) << "the toe";
  for (const StitchGuide& g : guides) {
    EXPECT_LT(g.in.vertex, 400) << "into the vessel";
    EXPECT_GE(g.out.vertex, 400) << "out of the stump";
    ASSERT_FALSE(g.in.path.empty());
  }
}

TEST(StitchGuide, TenOnACardWithinItsWidth) {
  TissueDescription t;
  t.thickness = 0.15e-3;
  t.cut_along = Vec3::UnitX();
  t.rest.resize(3, 2 * 9 * 5);
  for (int k = 0; k < t.rest.cols(); ++k) t.rest.col(k) = Vec3(1e-3 * ((k / 10) - 4) * 0.5, (k % 2 == 0 ? -1.0 : 1.0) * (0.1e-3 + 0.5e-3 * (k / 2 % 5)), 0.075e-3);
  t.triangles.push_back({0, 2, 4});
  NeedleTask ten = task("ten-stitches");
  ten.lapses = {};
  const auto guides = stitch_guides(t, needle(), ten);
  ASSERT_EQ(guides.size(), 10u);
  for (std::size_t k = 0; k < 10; ++k) {
    EXPECT_NEAR(guides[k].in.at.x(), (static_cast<double>(k) - 4.5) * 4e-3 / 11.0, 1e-9);
    EXPECT_NEAR(guides[k].in.at.y(), -0.4e-3, 1e-9);
    EXPECT_NEAR(guides[k].out.at.y(), 0.4e-3, 1e-9);
    EXPECT_NEAR(guides[k].in.at.z(), 0.075e-3, 1e-9);
  }
}

/// Stays at 120 degrees, not where eight stitches would lie.
TEST(StitchGuide, FollowsTheStitchesOfItsTask) {
  const TissueDescription t = vessel();
  const auto guides = stitch_guides(t, needle(), task("triangulation-120"));
  ASSERT_EQ(guides.size(), 6u);
  const auto outward = [&](const StitchGuide& g) {
    const Vec3 r = g.in.at - t.middle;
    return Vec3((r - r.dot(t.axis) * t.axis).normalized());
  };
  for (std::size_t a = 0; a < 3; ++a)
    for (std::size_t b = 0; b < a; ++b) EXPECT_NEAR(outward(guides[a]).dot(outward(guides[b])), -0.5, 1e-9);
  EXPECT_EQ(stitch_guides(t, needle(), task("artery-two-stitches")).size(), 2u);
}

TEST(StitchGuide, NothingWithoutTissueNeedleOrPlaces) {
  EXPECT_TRUE(stitch_guides({}, needle(), task("anastomosis-8")).empty());
  EXPECT_TRUE(stitch_guides(vessel(), {}, task("anastomosis-8")).empty());
  EXPECT_TRUE(stitch_guides(vessel(), needle(), task("vessel-handling")).empty());
}

}  // namespace stitch_guide_test
}  // namespace filum
