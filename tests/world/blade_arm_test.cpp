#include "world/blade_arm.h"

#include <gtest/gtest.h>

#include "world/model.h"
#include "world/world.h"

namespace filum {
namespace blade_arm_test {

BrainModel one_blade(bool keeps_force) {
  BrainModel m;
  m.blade_start = {Pose{}};
  m.blades = {{BladeShape{}, BladeShape{}}};
  m.placed.resize(1);
  m.arm_keeps_force = {static_cast<char>(keeps_force)};
  return m;
}

ToolInput hand_at(const Vec3& p, std::uint32_t buttons = 0) {
  ToolInput in;
  in.X_WD.p = p;
  in.valid = true;
  in.buttons = buttons;
  return in;
}

struct Driven {
  BrainModel model;
  BladeState blade;
  std::int32_t valid = 1;
  Observation o;
  explicit Driven(bool keeps_force) : model(one_blade(keeps_force)) {}
  void move(const ToolInput& in, double time = 0.0) { move_blade(model, 0, in, time, 1e-3, blade, valid, o); }
};

TEST(BladeArm, NextLocksAndFreesAndTheBladeIsTakenWhereItIs) {
  Driven d(false);
  d.move(hand_at(Vec3(1e-4, 0, 0)));
  EXPECT_NEAR(d.blade.X_W.p.x(), 1e-4, 1e-15);
  d.move(hand_at(Vec3(1e-4, 0, 0), 4));
  d.move(hand_at(Vec3(0.02, 0, 0), 4));  // held: no second press
  EXPECT_EQ(d.blade.parked, 2);
  d.move(hand_at(Vec3(0.02, 0, 0)));
  EXPECT_NEAR(d.blade.X_W.p.x(), 1e-4, 1e-15);
  d.move(hand_at(Vec3(0.02, 0, 0), 4));
  EXPECT_EQ(d.blade.parked, 0);
  d.move(hand_at(Vec3(0.02 + 1e-4, 0, 0)));
  EXPECT_NEAR(d.blade.X_W.p.x(), 2e-4, 1e-12) << "goes on from where it was";
  d.move(hand_at(Vec3(0.03, 0, 0), 1));
  d.move(hand_at(Vec3(0.04, 0, 0), 1));
  EXPECT_EQ(d.blade.parked, 1);
  d.move(hand_at(Vec3(0.04, 0, 0)));
  EXPECT_EQ(d.blade.parked, 0);
  EXPECT_NEAR(d.blade.X_W.p.x(), 2e-4, 1e-12);
  EXPECT_EQ(d.o.n_events, 4);
}

/// A spring of 200 N/m pushes back along +x; it weakens to half while the arm holds.
TEST(BladeArm, AnArmThatKeepsItsForceFollowsWhatGivesWay) {
  for (const bool keeps : {true, false}) {
    Driven d(keeps);
    double stiffness = 200.0;
    const auto push = [&] { d.blade.force = Vec3(stiffness * std::max(0.0, -d.blade.X_W.p.x()), 0, 0); };
    for (int k = 1; k <= 20; ++k) {
      d.move(hand_at(Vec3(-1e-4 * k, 0, 0)));
      push();
    }
    EXPECT_NEAR(d.blade.force.x(), 0.4, 1e-9);
    d.move(hand_at(Vec3(-2e-3, 0, 0), 4));
    for (int k = 0; k < 20000; ++k) {
      stiffness = 200.0 * (1.0 - 0.5 * std::min(1.0, k / 10000.0));
      d.move(hand_at(Vec3(-2e-3, 0, 0)));
      push();
    }
    EXPECT_NEAR(d.blade.force.x(), keeps ? 0.4 : 0.2, 0.01);
    EXPECT_NEAR(d.blade.X_W.p.x(), keeps ? -4e-3 : -2e-3, 1e-4);
  }
}

TEST(BladeArm, ThePlacedBladeGoesItsWayAndThenStays) {
  Driven d(false);
  d.blade.parked = 2;
  d.model.placed[0] = {{0.0, Pose{}}, {1.0, Pose{Vec3(0, 0, -0.02), Quat::Identity()}}};
  EXPECT_NEAR(placed_at(d.model.placed[0], 0.5).p.z(), -0.01, 1e-15);
  d.move(hand_at(Vec3(0.01, 0, 0), 4), 0.4);  // nobody takes it on its way
  EXPECT_EQ(d.blade.parked, 2);
  for (int k = 0; k < 600; ++k) d.move(hand_at(Vec3(0.01, 0, 0)), 0.4 + 1e-3 * k);
  EXPECT_NEAR(d.blade.X_W.p.z(), -0.02, 1e-4);
  d.move(hand_at(Vec3(0.01, 0, 0)), 1.5);
  EXPECT_NEAR(d.blade.X_W.p.z(), -0.02, 1e-4);
}

TEST(BladeArm, ANewFormIsAskedForOncePerPress) {
  Driven d(false);
  int asked = 0;
  const auto ask = [&](std::uint32_t buttons, double time = 0.0) { asked += asks_for_form(d.model, 0, hand_at(Vec3::Zero(), buttons), time, d.blade) ? 1 : 0; };
  for (const std::uint32_t buttons : {0u, 2u, 2u, 0u, 2u}) ask(buttons);
  EXPECT_EQ(asked, 2);
  ask(0);
  d.model.placed[0] = {{0.0, Pose{}}, {1.0, Pose{}}};
  ask(2, 0.5);
  EXPECT_EQ(asked, 2) << "while somebody else puts it in";
  d.model.placed[0].clear();
  d.model.blades[0].pop_back();
  ask(0);
  ask(2);
  EXPECT_EQ(asked, 2) << "there is no other";
}

/// The scene of the task: the force is kept while the tissue relaxes under the blade.
TEST(BladeArm, KeepsItsForceOnRelaxingTissue) {
  World world(load_model(FILUM_SOURCE_DIR, "retractor-correction"));
  Inputs in;
  in.tools[0].X_WD = world.model().brain->blade_start[0];
  in.tools[0].valid = true;
  for (int k = 0; k < 760; ++k) world.step(in);  // put in by somebody else
  ASSERT_TRUE(world.observation().brain.blades[0].parked);
  EXPECT_GT(world.observation().brain.blades[0].peak, 0.0);
  in.tools[0].X_WD = world.observation().tools[0].X_WT;
  in.tools[0].buttons = 4;
  world.step(in);
  in.tools[0].buttons = 0;
  world.step(in);
  ASSERT_FALSE(world.observation().brain.blades[0].parked);
  in.tools[0].buttons = 4;
  world.step(in);
  const double locked = world.observation().brain.blades[0].force_W.norm();
  in.tools[0].buttons = 0;
  for (int k = 0; k < 600; ++k) world.step(in);  // 30 s of the patient
  EXPECT_TRUE(world.observation().brain.blades[0].keeps_force);
  EXPECT_NEAR(world.observation().brain.blades[0].force_W.norm(), locked, 0.1 * locked);
}

}  // namespace blade_arm_test
}  // namespace filum
