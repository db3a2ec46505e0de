#include "world/world.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "tests/allocation_count.h"
#include "world/model.h"
#include "world/state.h"

namespace filum {
namespace world_test {

std::shared_ptr<const Model> scene() {
  static const auto model = load_model(FILUM_SOURCE_DIR, "knot-square");
  return model;
}

/// What a hand would do: the first tool goes down on the long end of the thread, closes, lifts and swings it.
Inputs hand(int step) {
  const Model& m = *scene();
  Inputs in;
  for (std::size_t i = 0; i < m.instruments.size(); ++i) in.tools[i] = {m.instrument_start[i], 0.2, 0.0, false, true, 0};
  ToolInput& t = in.tools[0];
  const Vec3 handle = t.X_WD.q * Vec3::UnitZ();
  const Vec3 on_thread = Vec3(0.5 * t.X_WD.p.x(), m.thread_path(1, 0), m.thread_path(2, 0)) - 0.8e-3 * handle;  // near the post it sags little
  const double down = std::clamp(step / 150.0, 0.0, 1.0), up = std::clamp((step - 220) / 200.0, 0.0, 1.0);
  t.X_WD.p = (1.0 - down) * t.X_WD.p + down * on_thread + up * Vec3(1e-3, 2e-3 * std::sin(0.02 * step), 3e-3);
  if (step > 170) t.grip_angle = -0.08;
  return in;
}

void run(World& w, int from, int to) {
  for (int k = from; k < to; ++k) w.step(hand(k));
}

TEST(World, InstrumentsStopAtTheSheetAndAtThePostUnlessTheSceneLeavesThatOut) {
  for (const bool touch : {true, false}) {
    auto m = std::make_shared<Model>(*scene());
    m->instruments_touch = touch;
    World w(m);
    Inputs in = hand(0);
    const auto lead = [&](const Vec3& to) {
      const Vec3 from = in.tools[0].X_WD.p;
      for (int k = 1; k <= 200; ++k) {
        in.tools[0].X_WD.p = from + k / 200.0 * (to - from);
        w.step(in);
      }
      for (int k = 0; k < 100; ++k) w.step(in);
      return w.state().instruments[0].X_WT.p.z();
    };
    EXPECT_EQ(lead(Vec3(-25e-3, 20e-3, -6e-3)) > m->description.floor_height - 10e-6, touch);
    lead(Vec3(-25e-3, 20e-3, 5e-3));
    in.tools[0].X_WD.q = Quat(Eigen::AngleAxisd(M_PI_2, Vec3::UnitY()));  // the handle along +x
    lead(Vec3(-4e-3, 4e-3, 5e-3));
    EXPECT_EQ(lead(Vec3(-4e-3, 4e-3, 0.0)) > 0.5e-3, touch) << "the jaws lie on the post";
  }
}

TEST(World, AShaftThatIsFlungAtTheThreadDoesNotPassIt) {
  for (const double speed : {150.0, 300.0, 600.0}) {  // [rad/s]: 5 to 20 m/s where it meets the thread
    SCOPED_TRACE(speed);
    auto m = std::make_shared<Model>(*scene());
    m->instruments_touch = false;
    World w(m);
    State s = w.state();
    const int node = s.thread.n - s.thread.n / 4;
    InstrumentState& tool = s.instruments[0];
    tool.X_WT = tool.X_WD = {s.thread.x.col(node) + Vec3(0, -8e-3, -35e-3), Quat::Identity()};
    tool.w = Vec3(-speed, 0, 0);
    w.restore(s);
    for (int k = 0; k < 40; ++k) {
      w.step(Inputs{});
      const State& now = w.state();
      const Pose& X = now.instruments[0].X_WT;
      const Vec3 in_front = (X.q * Vec3::UnitZ()).cross(Vec3::UnitX());
      ASSERT_GT(in_front.dot(now.thread.x.col(node) - X.p), 0.0) << "step " << k;
      ASSERT_LT(now.instruments[0].w.norm(), speed) << "nor is it thrown back";
    }
  }
}

TEST(World, HandTakesTheThread) {
  World w(scene());
  bool grasped = false;
  for (int k = 0; k < 450; ++k) {
    w.step(hand(k));
    for (int e = 0; e < w.observation().n_events; ++e) grasped = grasped || std::string(w.observation().events[static_cast<std::size_t>(e)].name) == "grasp";
    ASSERT_TRUE(w.state().thread.x.leftCols(w.state().thread.n).allFinite());
  }
  EXPECT_TRUE(grasped);
  EXPECT_GE(w.observation().tools[0].grasped_edge, 0);
  EXPECT_GT(w.observation().tools[0].grip_force, 0.1);
  EXPECT_EQ(w.observation().step, 450u);
}

TEST(World, SameInputsGiveBitEqualStates) {
  World a(scene()), b(scene());
  EXPECT_EQ(a.state_hash(), b.state_hash());
  for (int k = 0; k < 450; ++k) {
    a.step(hand(k));
    b.step(hand(k));
    ASSERT_EQ(a.state_hash(), b.state_hash()) << k;
  }
  Inputs other = hand(450);
  other.tools[0].X_WD.p.x() += 1e-9;
  a.step(hand(450));
  b.step(other);
  EXPECT_NE(a.state_hash(), b.state_hash());
}

TEST(World, RestoredSnapshotGoesOnAsIfNeverInterrupted) {
  World whole(scene());
  run(whole, 0, 250);
  const State snapshot = whole.state();
  ASSERT_FALSE(snapshot.memory.grasps.empty()) << "the snapshot is taken with the thread in hand";
  run(whole, 250, 550);
  World fresh(scene());
  fresh.restore(snapshot);
  run(fresh, 250, 550);
  EXPECT_EQ(fresh.array_hashes(), whole.array_hashes());
  EXPECT_EQ(fresh.state_hash(), whole.state_hash());
  World used(scene());  // one that has been elsewhere in between
  run(used, 0, 400);
  used.restore(snapshot);
  run(used, 250, 550);
  EXPECT_EQ(used.array_hashes(), whole.array_hashes());
}

/// Same state, same inputs, same next state, whatever the world was busy with before: here a longer thread, in each octant about the end of the first.
TEST(World, RestoredSnapshotGoesOnAlikeWhateverWasBefore) {
  World used(scene());
  const State first = used.state();
  const int last = first.thread.n - 1, more = scene()->description.capacity;
  for (int octant = 0; octant < 8; ++octant) {
    const Vec3 to((octant & 1) != 0 ? 1e-3 : -1e-3, (octant & 2) != 0 ? 1e-3 : -1e-3, (octant & 4) != 0 ? 1e-3 : -1e-3);
    State longer = first;
    Points x(3, more);
    for (int i = 0; i < more; ++i) x.col(i) = first.thread.x.col(last) + (i - last) * 0.3 * to;
    longer.thread = RodState::from_nodes(x, more);
    used.restore(longer);
    used.step(Inputs{});
    used.restore(first);
    World fresh(scene());
    for (int k = 0; k < 3; ++k) {
      used.step(Inputs{});
      fresh.step(Inputs{});
      EXPECT_EQ(used.array_hashes(), fresh.array_hashes()) << "octant " << octant << ", step " << k;
    }
  }
}

TEST(World, InputThatIsNotANumberIsIgnored) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN(), kInf = std::numeric_limits<double>::infinity();
  World w(scene());
  run(w, 0, 100);
  const Vec3 before = w.observation().tools[0].X_WT.p;
  for (int k = 0; k < 60; ++k) {
    Inputs in = hand(100);
    ToolInput& t = in.tools[0];
    t.X_WD.p += Vec3(0.1, 0, 0);  // it would be seen if it were followed
    if (k % 5 == 0) t.X_WD.p.x() = kNan;
    if (k % 5 == 1) t.X_WD.q.w() = kInf;
    if (k % 5 == 2) t.grip_angle = kNan;
    if (k % 5 == 3) t.X_WD.q.coeffs().setZero();
    if (k % 5 == 4) t.grip_force = kNan;
    w.step(in);
    EXPECT_FALSE(w.observation().tools[0].input_valid);
    EXPECT_TRUE(w.observation().tools[1].input_valid);
  }
  EXPECT_LT((w.observation().tools[0].X_WT.p - before).norm(), 1e-3);
  EXPECT_TRUE(w.state().thread.x.leftCols(w.state().thread.n).allFinite());
  EXPECT_TRUE(w.state().thread.v.leftCols(w.state().thread.n).allFinite());
  for (const InstrumentState& i : w.state().instruments) EXPECT_TRUE(i.X_WT.finite() && i.v.allFinite() && std::isfinite(i.angle));
}

TEST(World, AnInputComesBackOnlyAfterItWasLost) {
  for (const char* task : {"knot-square", "press-to-target"}) {
    World w(load_model(FILUM_SOURCE_DIR, task));
    Inputs in;
    w.step(in);
    EXPECT_EQ(w.observation().n_events, 0) << task << ": nothing was ever heard";
    EXPECT_FALSE(w.observation().tools[0].input_valid);
    const auto live = [&](bool valid) {
      in.tools[0].X_WD = w.observation().tools[0].X_WT;
      in.tools[0].valid = valid;
      w.step(in);
      return w.observation().n_events == 0 ? std::string() : std::string(w.observation().events[0].name);
    };
    EXPECT_EQ(live(true), "") << task << ": heard for the first time";
    EXPECT_TRUE(w.observation().tools[0].input_valid);
    EXPECT_EQ(live(false), "input-lost") << task;
    EXPECT_FALSE(w.observation().tools[0].input_valid);
    EXPECT_EQ(live(false), "") << task;
    EXPECT_EQ(live(true), "input-back") << task;
  }
}

TEST(World, SilentDeviceKeepsItsToolStill) {
  World w(scene());
  run(w, 0, 1);
  Inputs silent = hand(140);
  silent.tools[0].valid = false;
  w.step(silent);
  ASSERT_EQ(w.observation().n_events, 1);
  EXPECT_STREQ(w.observation().events[0].name, "input-lost");
  EXPECT_EQ(w.observation().events[0].tool, 0);
  for (int k = 0; k < 300; ++k) w.step(silent);
  EXPECT_NEAR((w.observation().tools[0].X_WT.p - hand(0).tools[0].X_WD.p).norm(), 0.0, 1e-6);
  EXPECT_LT(w.observation().tools[0].v_W.norm(), 1e-5);
  w.step(hand(0));
  EXPECT_STREQ(w.observation().events[0].name, "input-back");
}

/// A straight thread in air without weight, which two instruments take 6 mm apart and draw apart along x.
struct Pull {
  static std::shared_ptr<const Model> bench() {
    auto m = std::make_shared<Model>(*scene());
    m->lips.clear();
    m->description.notch.clear();
    m->description.post.p_W = m->description.base.p_W = Vec3(0.0, 0.0, 0.1);
    m->step.gravity.setZero();
    return m;
  }

  void step(double apart) {
    Inputs in;
    for (std::size_t i = 0; i < model->instruments.size(); ++i) in.tools[i] = {model->instrument_start[i], 0.2, 0.0, false, true, 0};
    for (std::size_t i = 0; i < 2; ++i) {
      ToolInput& t = in.tools[i];
      const Vec3 along = i == 0 ? Vec3(-1.0, 0.0, 0.0) : Vec3(1.0, 0.0, 0.0);
      const Vec3 on_thread = Vec3(-7e-3, 0.0, 0.0) + 3e-3 * along - 0.8e-3 * (t.X_WD.q * Vec3::UnitZ());
      const double down = std::clamp(steps / 200.0, 0.0, 1.0);
      t.X_WD.p = (1.0 - down) * t.X_WD.p + down * on_thread + 0.5 * apart * along;
      if (steps > 250) t.grip_angle = -0.3;
    }
    world.step(in);
    ++steps;
    const Observation& o = world.observation();
    force = 0.5 * (o.tools[0].f_T_W.x() - o.tools[1].f_T_W.x());
    for (int e = 0; e < o.n_events; ++e) {
      if (std::string(o.events[static_cast<std::size_t>(e)].name) != "thread-break") continue;
      ++breaks;
      broke_at = o.events[static_cast<std::size_t>(e)].value;
    }
  }
  int parted_edges() const {
    const RodState& s = world.state().thread;
    return static_cast<int>((s.alive.head(s.n - 1).array() == 0).count());
  }

  std::shared_ptr<const Model> model = bench();
  World world{model};
  int steps = 0, breaks = 0;
  double force = 0.0;     // [N], of the thread on the instruments, along x
  double broke_at = 0.0;  // [N]
};

TEST(World, ThreadBreaksAtItsStrengthAndNotBelow) {
  Pull pull;
  const double strength = pull.model->thread.strength;
  while (pull.steps < 400) pull.step(0.0);
  ASSERT_GE(pull.world.observation().tools[0].grasped_edge, 0);
  ASSERT_GE(pull.world.observation().tools[1].grasped_edge, 0);
  constexpr double kSpeed = 2e-6;  // [m] a step: some thousandth of the strength
  double apart = 0.0;
  while (pull.force < 0.95 * strength && apart < 5e-3) pull.step(apart += kSpeed);
  ASSERT_GE(pull.force, 0.95 * strength) << "the thread never became as taut";
  for (int k = 0; k < 250; ++k) pull.step(apart);
  EXPECT_EQ(pull.breaks, 0) << "below the strength";
  EXPECT_EQ(pull.parted_edges(), 0);
  double before = pull.force;
  while (pull.breaks == 0 && apart < 5e-3) {
    before = pull.force;
    pull.step(apart += kSpeed);
  }
  ASSERT_EQ(pull.breaks, 1);
  EXPECT_GT(pull.broke_at, strength);
  EXPECT_NEAR(pull.broke_at, strength, 0.01 * strength);
  EXPECT_NEAR(before, strength, 0.03 * strength) << "as the instruments feel it";
EXPECT_EQ(pull.parted_edges(), 1);
  for (int k = 0; k < 250; ++k) pull.step(apart);
  EXPECT_EQ(pull.breaks, 1);
  EXPECT_LT(pull.force, 0.05 * strength) << "a parted thread carries nothing";
}

/// Scissors that close on the thread at this place of it [m].
void cut_at(World& w, double arc) {
  const Model& m = w.model();
  const auto scissors = static_cast<std::size_t>(std::ranges::find(m.instruments, "scissors", &InstrumentParameters::kind) - m.instruments.begin());
  State s = w.state();
  const auto [edge, f] = locate_arc(s.thread, arc);
  const Vec3 a = s.thread.x.col(edge), b = s.thread.x.col(edge + 1), along = (b - a).normalized();
  const Vec3 up = (Vec3::UnitZ() - along.z() * along).normalized();
  Mat3 r;
  r << along.cross(up), along, up;
  InstrumentState& tool = s.instruments[scissors];
  tool.X_WT = tool.X_WD = {Vec3((1.0 - f) * a + f * b - 0.5 * m.instruments[scissors].pads.length * up), Quat(r)};
  tool.v = tool.w = Vec3::Zero();
  tool.angle = 0.02;
  s.armed[scissors] = 1;
  w.restore(s);
  Inputs in;
  in.tools[scissors] = {tool.X_WT, -0.05, 0.0, false, true, 0};
  const int before = w.observation().n_parted;
  for (int k = 0; k < 400 && w.observation().n_parted == before; ++k) w.step(in);
  EXPECT_EQ(w.observation().n_parted, before + 1) << 1e3 * arc << " mm";
}

TEST(World, ALooseEndThatIsCutAgainIsNoPartOfTheKnot) {
  for (const auto& [first, then] : {std::pair{2.5e-3, 4e-3}, std::pair{4e-3, 2.5e-3}}) {
    World w(scene());
    for (int k = 0; k < 200; ++k) w.step(Inputs{});
    cut_at(w, first);
    cut_at(w, then);
    const Observation& o = w.observation();
    ASSERT_EQ(o.n_parted, 2);
    EXPECT_EQ(o.cut_edge_low, o.parted[1]) << "cut at " << 1e3 * first << ", then " << 1e3 * then << " mm";
    EXPECT_EQ(o.cut_edge_high, -1);
  }
}

TEST(World, StepOfOursAllocatesNothing) {
  if (!FILUM_COUNTS_ALLOCATIONS) GTEST_SKIP() << "allocations cannot be counted under a sanitizer";
  World w(scene());
  run(w, 0, 200);
  const long before = allocations;
  run(w, 200, 450);  // grasp, lift, contact, changes of resolution
  const double each = static_cast<double>(allocations - before) / 250.0;
  RecordProperty("allocations_per_step", std::to_string(each));
  // What is left is ODE's: it takes its scratch memory anew now and then (at most two sub-steps a step).
  Instruments instruments(scene()->instruments);
  std::vector<InstrumentState> states(scene()->instruments.size());
  std::vector<InstrumentCommand> commands(states.size());
  const std::vector<Vec3> zero(states.size(), Vec3::Zero());
  for (int k = 0; k < 10; ++k) instruments.step(states, commands, zero, zero, scene()->step.dt);
  const long start = allocations;
  for (int k = 0; k < 250; ++k) instruments.step(states, commands, zero, zero, scene()->step.dt);
  const double of_ode = static_cast<double>(allocations - start) / 250.0;
  EXPECT_LE(each, of_ode + 1e-9) << "ODE alone takes " << of_ode << " a step";
  EXPECT_LE(of_ode, 200.0);
  const State copy = w.state();
  EXPECT_GT(allocations, start + 5) << "the counter works";
}

}  // namespace world_test
}  // namespace filum
