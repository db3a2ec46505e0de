#include "evidence/wall_watch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>
#include <vector>

#include "evidence/sewn_bench.h"
#include "evidence/wild_hands.h"
#include "physics/rod_pieces.h"
#include "physics/thread_grasp.h"
#include "world/needle_model.h"
#include "world/vessel_model.h"
#include "world/world.h"

namespace filum {
namespace wall_watch_test {

/// Two stumps sewn by construction, ten steps later: the thread is in its tracks and nowhere else in the tissue (as laid its free end grazes a stump).
struct Sewn {
  std::shared_ptr<const Model> model;
  State state;
  Sewn() {
    std::tie(model, state) = sewn_stumps(load_model(FILUM_SOURCE_DIR, "vessel-stitch"), 4);
    World world(model);
    world.restore(state);
    for (int k = 0; k < 10; ++k) world.step(Inputs{});
    state = world.state();
  }
  double whole() const { return arc_of_end(state.thread); }
};

/// A card beside needle and thread, and the middle of an element in the midst of a flap.
struct Card {
  std::shared_ptr<const Model> model = load_model(FILUM_SOURCE_DIR, "card-stitches");
  World world{model};
  State state = world.state();
  int element = model->vessel->mesh.n_elements() / 4 + 8;
  Vec3 middle = Vec3::Zero(), normal = Vec3::Zero();
  Card() {
    const auto& nodes = model->vessel->mesh.elements[static_cast<std::size_t>(element)];
    for (std::size_t a = 0; a < 8; ++a) {
      middle += 0.125 * state.tissue.wall.x.col(nodes[a]);
      normal += (a < 4 ? -0.25 : 0.25) * state.tissue.wall.x.col(nodes[a]);
    }
    normal.normalize();
  }
  /// The needle's middle at `height` [m] above the middle of the element, its wire along `along` there.
  void lay_needle(double height, const Vec3& along) {
    const NeedleShape& shape = model->needle->shape;
    state.needle.X_WN.q = Quat::FromTwoVectors(shape.tangent(half()), along);
    state.needle.X_WN.p = middle + height * normal - state.needle.X_WN.q * shape.point(half());
  }
  double half() const { return 0.5 * model->needle->shape.length(); }
};

TEST(WallWatch, ThreadInItsTracksIsLeftAlone) {
  const Sewn sewn;
  WallWatch watch(*sewn.model);
  watch.look(sewn.state);
  EXPECT_TRUE(watch.buried().empty());
  EXPECT_EQ(watch.longest().steps, 0);
}

TEST(WallWatch, ThreadThroughAWallWithoutATrackIsFoundAtEveryPlaceAndStepsAreCounted) {
  Sewn sewn;
  const TrackState tracks = sewn.state.tissue.tracks;
  sewn.state.tissue.tracks.n = 0;
  WallWatch watch(*sewn.model);
  for (int k = 1; k <= 4; ++k) {
    watch.look(sewn.state);
    EXPECT_EQ(watch.longest().steps, k);
  }
  for (int i = 0; i < tracks.n; ++i) {
    const NeedleTrack& t = tracks.tracks[static_cast<std::size_t>(i)];
    const double low = std::min(t.knots[0].strand, t.knots[static_cast<std::size_t>(t.n - 1)].strand);
    const double high = std::max(t.knots[0].strand, t.knots[static_cast<std::size_t>(t.n - 1)].strand);
    const bool found = std::any_of(watch.buried().begin(), watch.buried().end(), [&](const BuriedStrand& b) { return b.strand > low && b.strand < high; });
    EXPECT_TRUE(found) << "track " << i;
  }
  for (const BuriedStrand& b : watch.buried()) {
    EXPECT_GE(b.share, kDeepShare);
    EXPECT_LE(b.share, 0.55);
    EXPECT_LE(b.depth, 0.6 * sewn.model->vessel->thickness);
  }
  sewn.state.tissue.tracks = tracks;
  watch.look(sewn.state);
  EXPECT_EQ(watch.longest().steps, 0) << "what has come out is forgotten";
}

TEST(WallWatch, ThreadThatATouchDrawsBackIsLeftAloneAndOneThatRestsOnTheFarSideIsNot) {
  Sewn sewn;
  sewn.state.tissue.tracks.n = 0;
  WallWatch watch(*sewn.model);
  const VesselWall wall(sewn.model->vessel->mesh, sewn.model->vessel->layers, sewn.model->vessel->wall);
  watch.look(sewn.state);
  const std::vector<BuriedStrand> all(watch.buried().begin(), watch.buried().end());
  ASSERT_FALSE(all.empty());
  TouchState& touches = sewn.state.tissue.touches;
  for (const double side : {1.0, -1.0}) {
    touches.n = 0;
    for (const BuriedStrand& b : all) {
      SurfaceTouch& touch = touches.touches[static_cast<std::size_t>(touches.n++)];
      touch.arc = sewn.whole() + b.strand;
      touch.at = b.at;
      const Vec3 x = at_arc(sewn.state.thread, touch.arc);
      touch.normal = side * (wall.on_triangle(sewn.state.tissue.wall, touch.at) - x).normalized();
    }
    watch.look(sewn.state);
    EXPECT_EQ(watch.buried().empty(), side > 0.0);
  }
}

TEST(WallWatch, NothingIsBuriedBeforeAHandMoves) {
  for (const char* task : {"card-stitches", "vessel-stitch", "end-to-side", "anastomosis-vein", "needle-loading"}) {
    World world(load_model(FILUM_SOURCE_DIR, task));
    WallWatch watch(world.model());
    watch.look(world.state());
    EXPECT_TRUE(watch.buried().empty()) << task;
  }
}

TEST(WallWatch, ANeedleThroughTheCardIsFoundOneBesideItOrInATrackIsNot) {
  Card card;
  WallWatch watch(*card.model);
  const double half = card.half();
  for (const double height : {0.0, 30e-6, 60e-6, 0.1e-3}) {  // along the card, 150 um thick: 45 um deep is deep
    card.lay_needle(height, card.normal.unitOrthogonal());
    watch.look(card.state);
    EXPECT_EQ(!watch.buried().empty(), height < 40e-6) << height;
  }
  card.lay_needle(0.0, card.normal);
  watch.look(card.state);
  ASSERT_FALSE(watch.buried().empty());
  EXPECT_NEAR(watch.buried().front().strand, half, 40e-6);
  EXPECT_NEAR(watch.buried().front().share, 0.5, 0.05);
  TrackState& tracks = card.state.tissue.tracks;
  tracks.n = 1;
  tracks.tracks[0].n = 2;
  tracks.tracks[0].knots[0].strand = half + 0.1e-3;
  tracks.tracks[0].knots[1].strand = half - 0.1e-3;
  watch.look(card.state);
  EXPECT_TRUE(watch.buried().empty());
  tracks.tracks[0].knots[0].strand += 1e-3;  // the same track, somewhere else
  tracks.tracks[0].knots[1].strand += 1e-3;
  watch.look(card.state);
  EXPECT_FALSE(watch.buried().empty());
}

TEST(WallWatch, APlaceIsFollowedAlongTheWallAsTheStrandSlidesThrough) {
  Card card;
  WallWatch watch(*card.model);
  card.lay_needle(0.0, card.normal);
  for (int k = 1; k <= 4; ++k) {
    watch.look(card.state);
    EXPECT_EQ(watch.longest().steps, k);
    card.state.needle.X_WN.p += 0.3e-3 * card.normal;  // twice the card's thickness
  }
}

/// Thread whose tracks are forgotten is led out in time; pieces of it that are cut off within the wall have no end that tells which way.
TEST(WallWatch, ViolentHandsTellThreadThroughAWall) {
  Sewn sewn;
  World world(sewn.model);
  EXPECT_EQ(run_wild(world, sewn.state, 1, 40).fault, "");
  sewn.state.tissue.tracks.n = 0;
  const WildRun led_out = run_wild(world, sewn.state, 1, 40);
  EXPECT_EQ(led_out.fault, "");
  EXPECT_GT(led_out.buried, 1);
  VesselWall wall(sewn.model->vessel->mesh, sewn.model->vessel->layers, sewn.model->vessel->wall);
  wall.refit(sewn.state.tissue.wall);
  RodState& t = sewn.state.thread;
  const auto inside = [&](int i) {
    const WallCrossing near = wall.nearest(sewn.state.tissue.wall, t.x.col(i), 0.2e-3);
    return near.found && near.fraction < 0.0;
  };
  for (int i = 0; i + 1 < t.n; ++i) t.alive[i] = inside(i) && inside(i + 1) ? 1 : 0;
  ASSERT_GT(std::count(t.alive.begin(), t.alive.begin() + t.n - 1, 1), 0);
  const WildRun cut_off = run_wild(world, sewn.state, 1, 40);
  EXPECT_NE(cut_off.fault.find("without a track"), std::string::npos) << cut_off.fault;
}

}  // namespace wall_watch_test
}  // namespace filum
