#include "world/clamp_bars.h"

#include <gtest/gtest.h>

#include "collision/segment_distance.h"
#include "physics/implicit_rod.h"
#include "tests/allocation_count.h"
#include "world/model.h"
#include "world/scene_file.h"
#include "world/state.h"
#include "world/world.h"

namespace filum {
namespace clamp_bars_test {

constexpr std::uint32_t kSlide = 2, kTurn = 4, kOff = 8;  // buttons (world/inputs.h)

std::shared_ptr<const Model> stumps() {
  static const auto model = load_model(FILUM_SOURCE_DIR, "vessel-stitch");
  return model;
}
const VesselModel& vessel() { return *stumps()->vessel; }

RodMaterial nylon() {
  RodMaterial m;
  m.internal_friction = 0.01;
  return m;
}

/// A thread that lies across both arms of the upstream clamp, `gap` [m] above them.
struct Laid {
  RodMaterial m = nylon();
  ContactMaterial c;
  ImplicitRod rod{m, c, 41};
  RodState thread;
  RodMemory memory = rod.make_memory();
  RodStepOptions o;
  VesselState s;
  ClampBars clamp{vessel()};

  explicit Laid(double gap) {
    s.clamp.gap = vessel().clamp.gap;
    s.clamp.turn = vessel().clamp.turn;
    const ClampArms arms = clamp_arms(vessel());
    const Pose X = held_end(vessel(), s.clamp, 0);
    Points x = Points::Zero(3, 41);
    for (int i = 0; i < 41; ++i) x.col(i) = X * Vec3(0.1e-3 * (i - 20), 0, -arms.behind) + (arms.reach + m.radius + gap) * Vec3::UnitZ();
    thread = RodState::from_nodes(x, 41);
    clamp.add(s.clamp, 0.3, rod.obstacles);
  }
  void step(int n) {
    for (int k = 0; k < n; ++k) {
      clamp.move(s, rod.obstacles);
      rod.step(thread, memory, o);
    }
  }
  double lift() const { return rod.obstacles.bodies[0].force.z(); }
  double weight() const { return m.mass_per_length() * 4e-3 * 9.81; }
};

TEST(ClampBars, ThreadRestsOnTheArmsAndGoesWhereTheySlide) {
  Laid l(0.05e-3);
  const double before = l.thread.x.row(1).mean();
  l.step(500);
  EXPECT_NEAR(l.lift(), -l.weight(), 0.01 * l.weight());
  EXPECT_NEAR(l.thread.x.row(1).mean(), before, 1e-6);
  const double from = held_end(vessel(), l.s.clamp, 0).p.y();
  for (int k = 0; k < 400; ++k) {  // as fast as it slides
    l.s.clamp.gap -= 0.5e-3 * l.o.dt;
    l.step(1);
  }
  const double slid = held_end(vessel(), l.s.clamp, 0).p.y() - from;
  ASSERT_GT(std::abs(slid), 0.05e-3);
  EXPECT_NEAR(l.thread.x.row(1).mean() - before, slid, 0.05 * std::abs(slid)) << "friction carries it";
}

TEST(ClampBars, ThreadFallsThroughAClampThatIsOffOnTheVesselBehindIt) {
  Laid l(0.05e-3);
  l.s.blood.off[0] = 1;
  l.step(500);
  EXPECT_NEAR(l.thread.x.row(2).maxCoeff(), vessel().radius, 0.1e-3);
  EXPECT_LT(vessel().radius + 0.1e-3, clamp_arms(vessel()).reach);
}

TEST(ClampBars, ToolsAndNeedleTouchArmsAndBarOnly) {
  Laid l(1e-3);
  l.step(1);
  ASSERT_EQ(l.clamp.solid().size(), 5u);
  for (const RoundBar& bar : l.clamp.solid()) EXPECT_LT(bar.r_a, 0.25e-3) << "not the vessel that goes on";
  l.s.blood.off[1] = 1;
  l.step(1);
  EXPECT_EQ(l.clamp.solid().size(), 2u) << "the upstream arms; with one clamp off the bar is gone";
}

/// Forceps closed and led across the upstream clamp, through both arms, at half their height.
struct Across {
  World world;
  Inputs in;
  Vec3 middle, across;
  explicit Across(std::shared_ptr<const Model> model = stumps()) : world(std::move(model)) {
    const ClampState clamp = world.state().tissue.clamp;
    const ClampArms arms = clamp_arms(vessel());
    const Pose X = held_end(vessel(), clamp, 0);
    middle = X * Vec3(0, vessel().radius + 0.2e-3, -arms.behind);
    across = X.q * Vec3::UnitX();
    in.tools[0] = {{middle - 3e-3 * across, Quat::Identity()}, 0.0, 0.0, false, true, 0};
    steps(300);
  }
  void steps(int n) {
    for (int k = 0; k < n; ++k) world.step(in);
  }
  void lead(double way, double speed) {
    const Vec3 from = in.tools[0].X_WD.p;
    for (double gone = 0.0; gone < way;) {
      gone = std::min(way, gone + speed * 2e-3);
      in.tools[0].X_WD.p = from + gone * across;
      world.step(in);
    }
    steps(50);
  }
  double gone() const { return (world.observation().tools[0].X_WT.p - middle).dot(across); }
};

TEST(ClampBars, InstrumentsDoNotPassTheArmsAtTheSpeedOfHands) {
  for (const double speed : {0.05, 0.2, 0.5}) {
    Across a;
    a.lead(4e-3, speed);
    EXPECT_LT(a.gone(), -clamp_arms(vessel()).beside) << speed;
    EXPECT_GT(a.gone(), -clamp_arms(vessel()).beside - 1e-3) << speed << ": at the arm";
  }
}

/// A bar that stands still, between the hand and the clamp, is not forgotten for the clamp's.
TEST(ClampBars, WhatStandsBesideTheClampIsTouchedStill) {
  const Across there;
  auto model = std::make_shared<Model>(*stumps());
  model->description.has_post = true;
  PostShape& post = model->description.post;
  post.p_W = there.middle - 2e-3 * there.across;
  post.axis_W = Vec3::UnitY();
  post.half_length = 2e-3;
  post.radius = 0.2e-3;
  model->description.base = post;
  Across a(model);
  a.lead(4e-3, 0.05);
  EXPECT_LT(a.gone(), -2e-3);
}

TEST(ClampBars, SameAfterRestoreInTheMiddleOfATurn) {
  Across a;
  a.lead(3e-3, 0.05);
  a.in.tools[1].valid = true;
  a.in.tools[1].X_WD = stumps()->instrument_start[1];
  a.in.tools[1].buttons = kTurn;
  a.steps(100);
  World b(stumps());
  b.restore(a.world.state());
  for (int k = 0; k < 100; ++k) {
    a.world.step(a.in);
    b.step(a.in);
  }
  EXPECT_EQ(a.world.state_hash(), b.state_hash());
  a.in.tools[1].buttons = kSlide | kOff;
#if FILUM_COUNTS_ALLOCATIONS
  const long before = allocations;
  a.steps(50);
  EXPECT_EQ(allocations, before);
#endif
}

}  // namespace clamp_bars_test
}  // namespace filum
