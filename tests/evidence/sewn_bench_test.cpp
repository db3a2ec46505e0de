#include "evidence/sewn_bench.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string>

#include "physics/rod_pieces.h"
#include "physics/thread_grasp.h"
#include "world/needle_model.h"
#include "world/vessel_model.h"
#include "world/world.h"

namespace filum {
namespace sewn_bench_test {

/// A tool whose handle points along `handle` and whose jaws open along `opening`.
Quat facing(const Vec3& handle, const Vec3& opening) {
  Mat3 R;
  R.col(2) = handle.normalized();
  R.col(0) = (opening - opening.dot(R.col(2)) * R.col(2)).normalized();
  R.col(1) = R.col(2).cross(R.col(0));
  return Quat(R);
}

/// One stitch by construction in the digital artery of the course, with the shipped tissue and thread. Two instruments take its strands beside the vessel and draw
/// both away from it until something gives.
struct Overtightened {
  explicit Overtightened(int row) {
    auto still = std::make_shared<Model>(*load_model(FILUM_SOURCE_DIR, "artery-stitch"));
    still->step.gravity.setZero();
    std::tie(model, state) = sewn_stumps(still, 1, row);
    world = std::make_unique<World>(model);
    world->restore(state);
  }

  /// Of the tail (0), of the strand to the needle (1).
  Vec3 strand(std::size_t which) const {
    const TrackState& tracks = world->state().tissue.tracks;
    const RodState& t = world->state().thread;
    const double whole = arc_of_end(t);
    return at_arc(t, which == 0 ? whole + tracks.tracks[0].knots[0].strand - 2.5e-3 : whole + tracks.tracks[1].knots[2].strand + 2e-3);
  }

  void run() {
    const Vec3 out = model->vessel->cut_along;
    Inputs in;
    std::array<Vec3, 2> at, from;
    for (int k = 0; k < 4000 && given.empty(); ++k) {
      for (std::size_t i = 0; i < 2; ++i) {
        ToolInput& t = in.tools[i];
        const Vec3 handle = 0.8 * out + Vec3(0.0, i == 0 ? -0.4 : 0.4, 0.5);
        if (k < 300) at[i] = strand(i) - 0.45e-3 * handle.normalized();
        t.valid = true;
        t.X_WD.q = facing(handle, Vec3::UnitY());
        t.X_WD.p = at[i] + 15e-6 * std::max(0, 300 - k) * handle.normalized() + 4e-6 * std::max(0, k - 450) * out;
        t.grip_angle = k > 350 ? -0.3 : 0.4;
      }
      world->step(in);
      const Observation& o = world->observation();
      for (int e = 0; e < o.n_events; ++e) {
        const std::string name = o.events[static_cast<std::size_t>(e)].name;
        if (name != "tear" && name != "thread-break") continue;
        given = name;
        at_n = o.events[static_cast<std::size_t>(e)].value;
      }
    }
  }

  std::shared_ptr<const Model> model;
  State state;
  std::unique_ptr<World> world;
  std::string given;
  double at_n = 0.0;  // [N]
};

TEST(SewnBench, OvertightenedASmallBiteTearsALargeOneBreaksTheThread) {
  Overtightened small(2), large(5);
  small.run();
  EXPECT_EQ(small.given, "tear");
  EXPECT_GT(small.at_n, 50e-3) << "50 to 150 mN pull a stitch of twice the wall out (clinical.md 6)";
  EXPECT_LT(small.at_n, 150e-3);
  large.run();
  EXPECT_EQ(large.given, "thread-break");
  EXPECT_EQ(large.world->state().tissue.tracks.tracks[0].torn, 0.0);
}

}  // namespace sewn_bench_test
}  // namespace filum
