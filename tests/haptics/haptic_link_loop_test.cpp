// The closed loop of a hand, a haptic device, a line with delay, the 1 kHz loop and a scene at 500 Hz: stable, passive,
// within its limits, and without force when the line is cut. In simulated time; the device is hardware/haptic-link's.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <deque>
#include <limits>

#include "devices/haptic_link.h"
#include "hardware/haptic-link/simulated_master.h"
#include "haptics/haptic_loop.h"

namespace filum {
namespace haptic_link_loop_test {

/// Hands the loop what comes down the line, and the line what the loop gives back.
class LineEnd final : public Device {
 public:
  const std::string& name() const override { return name_; }
  void poll(std::int64_t now_us, std::vector<DeviceSample>& out) noexcept override {
    if (!arrived) return;
    DeviceSample sample = *arrived;
    sample.host_time_us = now_us;
    out.push_back(sample);
    arrived.reset();
  }
  void render(std::int64_t, const HandForces& forces) noexcept override { force = forces.force[0]; }
  DeviceHealth health() const noexcept override { return {DeviceState::live, 1, 0, 0, 0}; }
  std::int64_t stale_after_us() const noexcept override { return HapticLink::kStale; }

  std::optional<DeviceSample> arrived;
  Vec3 force = Vec3::Zero();

 private:
  std::string name_ = "line";
};

/// The world's instrument (physics/instrument.h: 30 g on 500 N/m, critically damped, implicit) over a plane at z = 0.
struct ToolOverPlane {
  double wall = 1000.0;  // [N/m]
  Vec3 p = Vec3::Zero(), v = Vec3::Zero(), f = Vec3::Zero(), p_D = Vec3::Zero();
  void step(const Vec3& command, double h) {
    const double m = 0.03, k = 500.0, c = 2.0 * std::sqrt(k * m);
    const Vec3 v_D = (command - p_D) / h;
    p_D = command;
    const Vec3 free = v + h / m * f;
    const Vec3 pull = (k * (p_D - p - h * free) + c * (v_D - free)) / (1.0 + h * c / m + h * h * k / m);
    v = free + h / m * pull;
    p += h * v;
    f = Vec3::Zero();
    if (p.z() < 0.0) f.z() = std::max(0.0, -wall * p.z() - 2.0 * v.z());  // as the scene answers: with its own losses
  }
};

struct Outcome {
  double given = 0.0;        // [J], most that the motors have given
  double peak = 0.0;         // [N]
  double slew = 0.0;         // [N/s]
  double swing = 0.0;        // [m], peak to peak in the last second
  double early_swing = 0.0;  // [m], between 1 and 2 s after the hand has come to rest
  double rest_force = 0.0;   // [N], mean in the last second
};

/// The hand moves 3 mm into the plane within half a second and stays there. `delay_ms` each way.
Outcome run(const MasterParameters& parameters, int delay_ms, double wall, int cut_at_ms = -1, double* force_after_cut = nullptr) {
  std::vector<std::unique_ptr<Device>> devices;
  auto end = std::make_unique<LineEnd>();
  LineEnd& line = *end;
  devices.push_back(std::move(end));
  HapticLoop loop(std::move(devices));
  SimulatedMaster master(parameters);
  ToolOverPlane tool{wall};
  std::deque<Vec3> up(static_cast<std::size_t>(delay_ms), Vec3::Zero()), down(static_cast<std::size_t>(delay_ms), Vec3::Zero());
  Outcome out;
  double low = 1.0, high = -1.0, early_low = 1.0, early_high = -1.0;
  Vec3 before = Vec3::Zero();
  for (int ms = 0; ms < 4500; ++ms) {
    const bool cut = cut_at_ms >= 0 && ms >= cut_at_ms;
    up.push_back(master.measured());
    DeviceSample sample;
    sample.has_pose = true;
    sample.X_WD.p = up.front();
    up.pop_front();
    if (!cut) line.arrived = sample;
    loop.tick(1000 * ms);
    if (ms % 2 == 1) {
      tool.step(loop.inputs().read().tools[0].X_WD.p, 2e-3);
      ToolStates& states = loop.tool_states().write_slot();
      states.tools[0] = {tool.p, tool.v, tool.f, true};
      states.time_us = 1000 * ms + 1000;
      loop.tool_states().publish();
    }
    down.push_back(line.force);
    const Vec3 wanted = down.front();
    down.pop_front();
    const double depth = 4e-3 * std::clamp(ms / 500.0, 0.0, 1.0);
    master.step(Vec3(0, 0, 1e-3 - depth), wanted, !cut, 1e-3);
    out.given = std::max(out.given, master.given());
    out.peak = std::max(out.peak, master.force().norm());
    const bool letting_go = master.force().norm() < before.norm();  // always allowed at once
    if (!letting_go) out.slew = std::max(out.slew, (master.force() - before).norm() / 1e-3);
    before = master.force();
    if (cut && force_after_cut && ms >= cut_at_ms + 2) *force_after_cut = std::max(*force_after_cut, master.force().norm());
    if (ms >= 1500 && ms < 2500) {
      early_low = std::min(early_low, master.position().z());
      early_high = std::max(early_high, master.position().z());
    }
    if (ms < 3500) continue;
    low = std::min(low, master.position().z());
    high = std::max(high, master.position().z());
    out.rest_force += master.force().z() / 1000.0;
  }
  out.swing = high - low;
  out.early_swing = early_high - early_low;
  return out;
}

void expect_safe(const MasterParameters& p, const Outcome& o) {
  EXPECT_LE(o.given, 2e-4 + 1e-7) << "passive";
  EXPECT_LE(o.peak, p.force_limit + 1e-12);
  EXPECT_LE(o.slew, 200.0 + 1e-6);
}

TEST(HapticLinkLoop, StableAndPassiveForAllHandsAndDelays) {
  double given = 0.0, swing = 0.0;
  for (const double hand : {50.0, 200.0, 500.0, 1000.0, 2000.0}) {
    for (const int delay : {0, 1, 2, 3, 5}) {
      for (const double wall : {300.0, 3000.0}) {
        MasterParameters p;  // 0.05 N of friction, as desktop devices have
        p.hand_stiffness = hand;
        p.hand_damping = 0.3 * 2.0 * std::sqrt(hand * p.mass);
        const Outcome o = run(p, delay, wall);
        expect_safe(p, o);
        EXPECT_LT(o.swing, 20e-6) << "hand " << hand << " delay " << delay << " wall " << wall;
        given = std::max(given, o.given);
        swing = std::max(swing, o.swing);
      }
    }
  }
  std::printf("50 runs with friction: at most %.1f uJ given to the hand, %.1f um of swing left\n", 1e6 * given, 1e6 * swing);
}

/// Nothing but the guard takes energy out: no friction, a tenth of critical damping in the hand. What is left of the 0.2 mJ
/// may keep a small swing alive; it neither grows nor exceeds the tank.
TEST(HapticLinkLoop, WithoutFrictionItStaysPassiveAndDoesNotGrow) {
  double given = 0.0, swing = 0.0;
  for (const double hand : {50.0, 200.0, 500.0, 1000.0, 2000.0}) {
    for (const int delay : {0, 1, 2, 3, 5}) {
      for (const double wall : {300.0, 3000.0}) {
        MasterParameters p;
        p.friction = 0.0;
        p.hand_stiffness = hand;
        p.hand_damping = 0.1 * 2.0 * std::sqrt(hand * p.mass);
        const Outcome o = run(p, delay, wall);
        expect_safe(p, o);
        EXPECT_LT(o.swing, 1e-3);
        EXPECT_LT(o.swing, std::max(1.5 * o.early_swing, 300e-6)) << "hand " << hand << " delay " << delay << " wall " << wall;
        given = std::max(given, o.given);
        swing = std::max(swing, o.swing);
      }
    }
  }
  std::printf("50 runs without friction: at most %.1f uJ given to the hand, %.0f um of swing left\n", 1e6 * given, 1e6 * swing);
}

TEST(HapticLinkLoop, TheWallIsFeltWhereThereIsNoDelay) {
  MasterParameters p;
  p.friction = 0.0;
  const Outcome o = run(p, 0, 1000.0);
  // Hand 500 N/m, coupling 500, wall 1000 in series, 3 mm: 3e-3 / (1/500 + 1/500 + 1/1000) = 0.6 N.
  EXPECT_NEAR(o.rest_force, 0.6, 0.03);
}

TEST(HapticLinkLoop, NoForceTwoMillisecondsAfterTheLineIsCut) {
  double after = 0.0;
  const Outcome o = run({}, 1, 1000.0, 1500, &after);
  EXPECT_GT(o.peak, 0.3);
  EXPECT_EQ(after, 0.0);
}

TEST(HapticLinkLoop, CoarseEncodersStayWithinTheAccount) {
  MasterParameters p;
  p.encoder = 55e-6;  // of a Touch
  const Outcome o = run(p, 1, 1000.0);
  // Between two steps of the encoder the account cannot see: at most force times half a step at each end.
  EXPECT_LE(o.given, 2e-4 + 2.0 * o.peak * 27.5e-6);
  EXPECT_LT(o.swing, 400e-6);
}

TEST(HapticLinkLoop, NonsenseFromTheLineNeverReachesTheMotors) {
  filum_guard guard;
  filum_guard_init(&guard, 3.0);
  double out[3];
  const double here[3] = {0, 0, 0};
  for (const double bad : {1e9, -1e9, std::nan(""), std::numeric_limits<double>::infinity()}) {
    const double wanted[3] = {bad, 0.0, bad};
    for (int k = 0; k < 100; ++k) {
      filum_guard_step(&guard, here, wanted, true, 1e-3, out);
      ASSERT_TRUE(std::isfinite(out[0]) && std::isfinite(out[2]));
      ASSERT_LE(std::hypot(out[0], out[2]), 3.0 + 1e-12);
    }
  }
}

}  // namespace haptic_link_loop_test
}  // namespace filum
