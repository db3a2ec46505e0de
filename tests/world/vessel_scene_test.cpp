#include "world/vessel_scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "world/model.h"
#include "world/needle_model.h"
#include "world/state.h"
#include "world/world.h"

namespace filum {
namespace {

std::shared_ptr<const Model> scene() {
  static const auto model = load_model(FILUM_SOURCE_DIR, "card-stitches");
  return model;
}

TEST(VesselScene, CardLiesStillByItself) {
  World w(scene());
  Inputs in;
  const Points before = w.observation().tissue.positions;
  for (int k = 0; k < 200; ++k) w.step(in);
  EXPECT_LT((w.observation().tissue.positions - before).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_EQ(w.observation().tissue.n_passes, 0);
  EXPECT_EQ(w.observation().tissue.n, scene()->vessel->mesh.n_nodes());
}

TEST(VesselScene, JawPressesTheCardDownAndFeelsIt) {
  World w(scene());
  Inputs in;
  ToolInput& t = in.tools[0];
  t.valid = true;
  t.grip_angle = 0.0;
  double deepest = 0.0, felt = 0.0;
  for (int k = 0; k < 900; ++k) {
    t.X_WD.p = Vec3(0.0, 1.5e-3, 1.5e-3 - std::min(k, 750) * 2e-6);
    w.step(in);
    deepest = std::min(deepest, w.observation().tissue.positions.row(2).minCoeff());
    felt = std::max(felt, w.observation().tools[0].f_T_W.z());
  }
  EXPECT_LT(deepest, -0.15e-3) << "below where it lay";
  EXPECT_GT(felt, 1e-4);
}

/// Hands that jump about the field, open and close, at up to half a metre a second.
class WildHands {
 public:
  explicit WildHands(unsigned seed) : random_(seed) {}
  Inputs next() {
    Inputs in;
    for (std::size_t i = 0; i < 2; ++i) {
      if (left_[i]-- <= 0) {
        left_[i] = 40 + static_cast<int>(60 * (1.0 + number()));
        from_[i] = to_[i];
        steps_[i] = left_[i];
        to_[i].p = Vec3(4e-3 * number(), 4e-3 * number(), 1e-3 + 3e-3 * number());
        to_[i].q = Quat(number(), number(), number(), number()).normalized();
        grip_[i] = number() > 0.0 ? 0.15 : -0.05;
      }
      const double f = 1.0 - static_cast<double>(left_[i]) / steps_[i];
      ToolInput& t = in.tools[i];
      t.X_WD = {(1.0 - f) * from_[i].p + f * to_[i].p, from_[i].q.slerp(f, to_[i].q)};
      t.grip_angle = grip_[i];
      t.valid = true;
    }
    return in;
  }

 private:
  double number() { return std::uniform_real_distribution<double>(-1.0, 1.0)(random_); }
  std::mt19937 random_;
  std::array<Pose, 2> from_, to_;
  std::array<int, 2> left_{}, steps_{1, 1};
  std::array<double, 2> grip_{};
};

TEST(VesselScene, SurvivesWildHands) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    World w(scene());
    WildHands hands(seed);
    for (int k = 0; k < 1500; ++k) {
      w.step(hands.next());
      const State& s = w.state();
      ASSERT_TRUE(s.needle.X_WN.finite() && s.needle.v.allFinite()) << seed << ' ' << k;
      ASSERT_TRUE(s.thread.x.leftCols(s.thread.n).allFinite() && s.tissue.wall.x.allFinite()) << seed << ' ' << k;
    }
    const Observation& o = w.observation();
    EXPECT_LT(o.needle.X_WN.p.norm(), 50e-3) << "seed " << seed;
    EXPECT_LT((o.positions.col(o.n_nodes - 1) - o.needle.swage_W).norm(), 20e-6) << "thread and needle are joined still, seed " << seed;
    EXPECT_LT(o.tissue.positions.cwiseAbs().maxCoeff(), 10e-3) << "the card is where its frame is, seed " << seed;
  }
}

}  // namespace
}  // namespace filum
