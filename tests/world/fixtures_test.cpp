#include "world/fixtures.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "world/scene_file.h"
#include "world/vessel_model.h"

namespace filum {
namespace fixtures_test {

TEST(Fixtures, BarsAndSheetStandWhereTheSceneSays) {
  const auto model = load_model(FILUM_SOURCE_DIR, "knot-square", "");
  RodObstacles o(10);
  o.bodies.emplace_back();  // as of a tool that is there already
  add_fixtures(*model, o);
  ASSERT_EQ(o.bodies.size(), 2u);
  const PostShape& post = model->description.post;
  const Obstacle& bar = o.obstacles[0];
  EXPECT_EQ(bar.body, 1);
  EXPECT_EQ(bar.r_a, post.radius);
  EXPECT_NEAR((0.5 * (bar.a_B + bar.b_B) - post.p_W).norm(), 0.0, 1e-12);
  EXPECT_NEAR((bar.b_B - bar.a_B).norm(), 2.0 * post.half_length, 1e-12);
  EXPECT_EQ(bar.friction, model->post_friction);
  const auto planes = std::count_if(o.obstacles.begin(), o.obstacles.end(), [](const Obstacle& k) { return k.kind == Obstacle::Kind::plane; });
  EXPECT_EQ(planes, 1);
  for (const Obstacle& k : o.obstacles) {
    EXPECT_EQ(k.body, 1);
    if (k.kind == Obstacle::Kind::plane) {
      EXPECT_NEAR(k.a_B.z(), model->description.floor_height, 1e-15);
      EXPECT_NEAR((k.b_B - k.a_B - Vec3::UnitZ()).norm(), 0.0, 1e-12);
    }
  }
}

/// Four round bars: the sheet's border comes out of their middle, all the way round.
TEST(Fixtures, AFrameStandsRoundItsSheet) {
  const auto model = load_model(FILUM_SOURCE_DIR, "needle-course", "");
  RodObstacles o(10);
  add_fixtures(*model, o);
  ASSERT_EQ(model->description.frame.size(), 4u);
  EXPECT_EQ(std::count_if(o.obstacles.begin(), o.obstacles.end(), [](const Obstacle& k) { return k.kind == Obstacle::Kind::bar; }), 4);
  const VesselMesh& mesh = model->vessel->mesh;
  for (const int i : mesh.held) {
    const Vec3 middle = mesh.nodes.col(i).cwiseProduct(Vec3(1, 1, 0));
    double nearest = 1.0;  // [m], to a bar's surface
    for (const Obstacle& bar : o.obstacles) {
      if (bar.kind != Obstacle::Kind::bar) continue;
      const Vec3 axis = bar.b_B - bar.a_B;
      const double f = std::clamp((middle - bar.a_B).dot(axis) / axis.squaredNorm(), 0.0, 1.0);
      nearest = std::min(nearest, (bar.a_B + f * axis - middle).norm() - bar.r_a);
    }
    EXPECT_NEAR(nearest, -0.1e-3, 1e-9) << "the bars reach over its border";
  }
}

TEST(Fixtures, PostGripsTheThreadWhereItPassesTheSlit) {
  const auto model = load_model(FILUM_SOURCE_DIR, "knot-square", "");
  const RodState thread = RodState::from_nodes(model->thread_path, 240);
  const double to_slit = model->thread_path(0, 0) - 0.5 * (model->description.post.p_W + model->description.base.p_W).x();
  EXPECT_NEAR(arc_on_post(*model, thread), to_slit, 1e-5);
  RodState moved = thread;
  moved.x.row(0).array() += 2e-3;
  EXPECT_NEAR(arc_on_post(*model, moved), to_slit + 2e-3, 1e-5);
}

}  // namespace fixtures_test
}  // namespace filum
