// A blade in the hand at 1 kHz over a brain at 200 Hz: smooth in a slow press and release, stable against stiff hands. In
// simulated time; the device is hardware/haptic-link's.
#include "haptics/blade_feel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "hardware/haptic-link/simulated_master.h"
#include "haptics/haptic_loop.h"
#include "world/brain_model.h"
#include "world/model.h"
#include "world/world.h"

namespace filum {
namespace blade_feel_test {

class Hand final : public Device {
 public:
  const std::string& name() const override { return name_; }
  void poll(std::int64_t now_us, std::vector<DeviceSample>& out) noexcept override {
    sample.host_time_us = now_us;
    sample.has_pose = true;
    out.push_back(sample);
  }
  void render(std::int64_t, const HandForces& forces) noexcept override {
    force = forces.force[0];
    torque = forces.torque[0];
  }
  DeviceHealth health() const noexcept override { return {DeviceState::live, 1, 0, 0, 0}; }
  DeviceSample sample;
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();

 private:
  std::string name_ = "hand";
};

/// Hand, loop and brain; advance() is a millisecond.
struct Bench {
  World world{load_model(FILUM_SOURCE_DIR, "press-to-target")};
  Hand* hand;
  std::unique_ptr<HapticLoop> loop;
  Vec3 start;
  int ms = 0;

  Bench() {
    auto device = std::make_unique<Hand>();
    hand = device.get();
    std::vector<std::unique_ptr<Device>> devices;
    devices.push_back(std::move(device));
    loop = std::make_unique<HapticLoop>(std::move(devices));
    hand->sample.X_WD = world.model().brain->blade_start[0];
    start = hand->sample.X_WD.p;
  }
  void advance(const Vec3& moved) {
    hand->sample.X_WD.p = start + moved;
    loop->tick(1000 * ms);
    const int every = static_cast<int>(std::lround(1e3 * world.description().dt));
    if (ms % every == every - 1) {
      world.step(loop->inputs().read());
      loop->tool_states().write_slot() = tool_states_of(world.observation(), 1000 * ms + 1000);
      loop->tool_states().publish();
    }
    ++ms;
  }
  /// Through the air, at 10 mm/s, to `kAir` below the start, and on at 1 mm/s.
  void approach(int to_um) {
    for (int k = 0; k < kAir / 10; ++k) advance(Vec3(0, 0, -1e-5 * k));
    for (int k = kAir; k < to_um; ++k) advance(Vec3(0, 0, -1e-6 * k));
  }
  static constexpr int kAir = 7500;  // [um]
};

TEST(BladeFeel, BetweenStepsTheForceGrowsByTheLocalStiffness) {
  BladeFeel feel;
  feel.update(Vec3::Zero(), Vec3(0, 0, 0.1), 200.0 * Mat3::Identity(), Vec3::Zero(), 0);
  EXPECT_NEAR(feel.force(Vec3(0, 0, -1e-4), 3000).z(), 0.12, 1e-12);
  EXPECT_EQ(feel.force(Vec3(0, 0, 1e-3), 3000), Vec3(Vec3::Zero())) << "tissue does not pull";
  feel.update(Vec3::Zero(), Vec3(0, 0, 0.2), 200.0 * Mat3::Identity(), Vec3::Zero(), 5000);
  EXPECT_NEAR(feel.force(Vec3::Zero(), 5000).z(), 0.1, 1e-12) << "no jump";
  EXPECT_NEAR(feel.force(Vec3::Zero(), 7500).z(), 0.15, 1e-12);
  EXPECT_NEAR(feel.force(Vec3::Zero(), 20000).z(), 0.2, 1e-12);
}

TEST(BladeFeel, ASlowPressAndReleaseHasNoStepAboveTwoMillinewton) {
  Bench b;
  double before = 0.0, most = 0.0, peak = 0.0, world_most = 0.0, world_before = 0.0;
  b.approach(Bench::kAir);
  const int down = 4500, wait = 500;  // 1 mm/s
  for (int k = 0; k < 2 * down + wait; ++k) {
    const double depth = 1e-6 * (Bench::kAir + (k < down ? k : k < down + wait ? down : 2 * down + wait - k));
    b.advance(Vec3(0, 0, -depth));
    const double force = b.hand->force.norm(), scene = b.world.observation().tools[0].f_T_W.norm();
    most = std::max(most, std::abs(force - before));
    world_most = std::max(world_most, std::abs(scene - world_before));
    peak = std::max(peak, force);
    before = force;
    world_before = scene;
  }
  std::printf("press at 1 mm/s: peak %.3f N, largest change %.2f mN in a millisecond; the scene's own steps %.2f mN\n", peak, 1e3 * most, 1e3 * world_most);
  EXPECT_GT(peak, 0.05);
  EXPECT_LT(most, 2e-3);
  EXPECT_LT(before, 1e-6);
}

TEST(BladeFeel, TheHandFeelsTheTissuesOwnForceAndTorque) {
  Bench b;
  b.approach(11000);
  for (int k = 0; k < 400; ++k) b.advance(Vec3(0, 0, -11e-3));
  const Vec3 scene = b.world.observation().tools[0].f_T_W;
  EXPECT_GT(scene.norm(), 0.03);
  EXPECT_LT((b.hand->force - scene).norm(), 0.02 * scene.norm());
  const Vec3 torque = b.world.observation().brain.blades[0].torque_W;
  EXPECT_LT((b.hand->torque - torque).norm(), 0.01 * torque.norm());
}

TEST(BladeFeel, TheLocalStiffnessIsThatOfTheScene) {
  Bench b;
  b.approach(11000);
  for (int k = 0; k < 600; ++k) b.advance(Vec3(0, 0, -11e-3));
  const double told = b.world.observation().brain.blades[0].stiffness_W(2, 2), before = b.world.observation().tools[0].f_T_W.z();
  for (int k = 0; k < 600; ++k) b.advance(Vec3(0, 0, -11.1e-3));
  const double seen = (b.world.observation().tools[0].f_T_W.z() - before) / 1e-4;
  std::printf("local stiffness %.1f N/m, from two rests %.1f N/m\n", told, seen);
  EXPECT_GT(seen, 10.0);
  EXPECT_NEAR(told, seen, 0.35 * seen);  // nodes come and go at the border
}

/// The hand goes 4 mm into the tissue in half a second and stays.
TEST(BladeFeel, StableAndPassiveAgainstStiffHands) {
  for (const double stiffness : {200.0, 1000.0, 2000.0}) {
    Bench b;
    MasterParameters parameters;
    parameters.hand_stiffness = stiffness;
    SimulatedMaster master(parameters);
    double low = 1.0, high = -1.0, force = 0.0, early_low = 1.0, early_high = -1.0;
    for (int ms = 0; ms < 3500; ++ms) {
      b.advance(master.measured());
      master.step(Vec3(0, 0, -12e-3 * std::min(1.0, ms / 1000.0)), b.hand->force, true, 1e-3);
      force = std::max(force, master.force().norm());
      if (ms >= 1500 && ms < 2500) {
        early_low = std::min(early_low, master.position().z());
        early_high = std::max(early_high, master.position().z());
      }
      if (ms < 2500) continue;
      low = std::min(low, master.position().z());
      high = std::max(high, master.position().z());
    }
    std::printf("hand %.0f N/m: swing %.1f um, the second before %.1f um, given %.3f mJ, at most %.2f N\n", stiffness, 1e6 * (high - low), 1e6 * (early_high - early_low), 1e3 * master.given(), force);
    EXPECT_LE(master.given(), 2e-4 + 1e-7) << "passive";
    EXPECT_GT(force, 0.02);
    EXPECT_LT(high - low, 30e-6);
  }
}

}  // namespace blade_feel_test
}  // namespace filum
