#include "world/needle_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "tests/allocation_count.h"
#include "world/needle_model.h"
#include "world/world.h"

namespace filum {
namespace needle_scene_test {

std::shared_ptr<const Model> scene() {
  static const auto model = load_model(FILUM_SOURCE_DIR, "needle-loading");
  return model;
}

/// The forceps go down on the needle where it lies, a third of the way from the thread, close, and lift it.
Inputs hand(int step, double squeeze = -0.04) {
  const Model& m = *scene();
  Inputs in;
  for (std::size_t i = 0; i < m.instruments.size(); ++i) in.tools[i] = {m.instrument_start[i], 0.2, 0.0, false, true, 0};
  const NeedleShape& n = m.needle->shape;
  const double a = 0.33 * n.length();
  const Vec3 wire = m.needle->start.q * n.tangent(a), up = Vec3::UnitZ();
  Mat3 grip;
  grip << wire.cross(up), wire, up;
  ToolInput& t = in.tools[0];
  t.X_WD.q = Quat(grip).normalized();
  const double down = std::clamp(step / 200.0, 0.0, 1.0), lift = std::clamp((step - 350) / 200.0, 0.0, 1.0);
  t.X_WD.p = m.needle->start * n.point(a) - 0.15e-3 * up + ((1.0 - down) * 4e-3 + lift * 3e-3) * up;
  t.grip_angle = step > 230 ? squeeze : 0.15;
  return in;
}

bool saw(const Observation& o, const std::string& name) {
  return std::any_of(o.events.begin(), o.events.begin() + o.n_events, [&](const WorldEvent& e) { return name == e.name; });
}

TEST(NeedleScene, ForcepsTakeAndLiftTheNeedleAndTheThreadComesWithIt) {
  World w(scene());
  bool taken = false;
  for (int k = 0; k < 650; ++k) {
    w.step(hand(k));
    taken = taken || saw(w.observation(), "needle-taken");
  }
  EXPECT_TRUE(taken);
  const Observation& o = w.observation();
  EXPECT_TRUE(o.needle.held[0]);
  EXPECT_NEAR(o.needle.grip_share[0], 0.33, 0.03);
  EXPECT_NEAR(o.needle.grip_angle[0], 1.57, 0.02);
  EXPECT_GT(o.needle.X_WN.p.z(), scene()->description.floor_height + 2.5e-3);
  EXPECT_LT((o.positions.col(o.n_nodes - 1) - o.needle.swage_W).norm(), 1e-6) << "the thread's end is at the swage";
}

TEST(NeedleScene, OpenedJawsLetItFall) {
  World w(scene());
  for (int k = 0; k < 650; ++k) w.step(hand(k));
  for (int k = 650; k < 1400; ++k) w.step(hand(k, 0.15));
  const Observation& o = w.observation();
  EXPECT_FALSE(o.needle.held[0]);
  EXPECT_NEAR(o.needle.X_WN.p.z(), scene()->description.floor_height + scene()->needle->shape.wire_radius, 0.3e-3);
}

double apart(const World& w) { return (w.observation().positions.col(w.observation().n_nodes - 1) - w.observation().needle.swage_W).norm(); }

TEST(NeedleScene, PressedSwageFirstIntoTheSheetItKeepsItsThread) {
  World w(scene());
  for (int k = 0; k < 650; ++k) w.step(hand(k));
  Inputs in = hand(650);
  const Pose lifted = in.tools[0].X_WD;
  const Vec3 across = lifted.q * Vec3::UnitX();
  const bool swage_sinks = (w.observation().needle.swage_W - lifted.p).cross(Vec3(-Vec3::UnitZ())).dot(across) > 0;
  double most = 0;
  bool pressed = false;
  for (int k = 0; k < 800; ++k) {  // tilted until the swage points down, then put down by 4 mm
    const double tilt = std::min(k / 300.0, 1.0) * (swage_sinks ? 1.3 : -1.3), down = std::clamp((k - 300) / 300.0, 0.0, 1.0) * 4e-3;
    in.tools[0].X_WD = {lifted.p - down * Vec3::UnitZ(), Quat(Eigen::AngleAxisd(tilt, across)) * lifted.q};
    w.step(in);
    most = std::max(most, apart(w));
    pressed = pressed || w.observation().needle.swage_W.z() < scene()->description.floor_height + scene()->needle->shape.wire_radius;
  }
  EXPECT_TRUE(pressed);
  EXPECT_LT(most, 1e-6);  // [m]
}

/// The swage is foreseen under the last step's pull. Where the thread breaks there that pull is gone, and the step is made again (else: 51 um).
TEST(NeedleScene, AThreadThatBreaksAtTheSwageLeavesItsEndThere) {
  World w(scene());
  for (int k = 0; k < 650; ++k) w.step(hand(k));
  State broken = w.state();
  broken.needle.pull = Vec3(0.1, 0.0, 0.0);  // [N]
  broken.thread.alive[broken.thread.n - 2] = 0;
  w.restore(broken);
  w.step(hand(650));
  EXPECT_LT(apart(w), 1e-6);  // [m]
}

TEST(NeedleScene, SnapshotGoesOnBitEqualAndStepsAllocateNothing) {
  World whole(scene());
  for (int k = 0; k < 400; ++k) whole.step(hand(k));
  const State snapshot = whole.state();
  World fresh(scene());
  fresh.restore(snapshot);
  const long before = allocations;
  for (int k = 400; k < 600; ++k) whole.step(hand(k));
  const long used = allocations - before;
  for (int k = 400; k < 600; ++k) fresh.step(hand(k));
  EXPECT_EQ(whole.array_hashes(), fresh.array_hashes());
  EXPECT_EQ(whole.state_hash(), fresh.state_hash());
  if (!FILUM_COUNTS_ALLOCATIONS) return;
  Instruments instruments(scene()->instruments);  // what is left is ODE's
  std::vector<InstrumentState> states(scene()->instruments.size());
  const std::vector<InstrumentCommand> commands(states.size());
  const std::vector<Vec3> zero(states.size(), Vec3::Zero());
  for (int k = 0; k < 10; ++k) instruments.step(states, commands, zero, zero, scene()->step.dt);
  const long start = allocations;
  for (int k = 0; k < 200; ++k) instruments.step(states, commands, zero, zero, scene()->step.dt);
  EXPECT_LE(used, allocations - start + 5);
}

}  // namespace needle_scene_test
}  // namespace filum
