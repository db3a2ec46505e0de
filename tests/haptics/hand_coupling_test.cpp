#include "haptics/hand_coupling.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <deque>
#include <vector>

namespace filum {
namespace hand_coupling_test {

/// A hand on a haptic device: a mass on a spring towards where the person wants to be, hardly damped. It gets
/// the rendered force held constant for a millisecond, as a real device does.
struct Hand {
  double mass, stiffness, damping;  // [kg], [N/m], [N s/m]
  double x = 0.0, v = 0.0;
  void advance(double wanted, double force, double time) {
    constexpr double h = 1e-5;
    for (double t = 0.0; t < time - h / 2; t += h) {
      v += h / mass * (stiffness * (wanted - x) - damping * v + force);
      x += h * v;
    }
  }
};

/// The world at 500 Hz: a tool drawn after the commanded pose and a wall at x < 0, both implicit.
struct ToolWorld {
  double wall;  // [N/m]
  double x = 0.0, v = 0.0;
  void step(double commanded) {
    constexpr double h = 2e-3, m = 0.03, k = 500.0, c = 7.7;
    const double wall_now = x < 0.0 ? wall : 0.0;
    const double f = k * (commanded - x) - c * v - wall_now * x;
    v += h / m * (f - h * (k + wall_now) * v) / (1.0 + h * c / m + h * h * (k + wall_now) / m);
    x += h * v;
  }
};

struct Outcome {
  double most_delivered = 0.0;  // [J], largest net energy given to the hand
  double last_swing = 0.0;      // [m], peak to peak in the last 0.5 s, when the person holds still
  double early_swing = 0.0;     // [m], the same just after the person came to rest
  double peak_force = 0.0, peak_slew = 0.0;
  std::uint64_t held_back = 0;
};

/// `delay`: age of the world's state in its own steps; many when the world cannot keep up.
Outcome press_a_wall(Hand hand, double wall, HandCouplingOptions options, std::size_t delay = 0) {
  HandCoupling coupling(options);
  ToolWorld world{wall};
  std::deque<ToolWorld> past;
  hand.x = world.x = 5e-3;
  past.assign(delay + 1, world);
  Outcome run;
  double force = 0.0, given = 0.0;
  double low[2] = {1, 1}, high[2] = {-1, -1};
  for (int tick = 0; tick < 4000; ++tick) {
    const double t = 1e-3 * tick;
    // Presses to 4 mm inside the wall, taps at 5 Hz, then holds still against it.
    const double wanted = t < 2.0 ? 0.5e-3 - 4.5e-3 * std::sin(31.4 * t) : -2e-3;
    // The world's state is one of its steps old when it is used, as between threads.
    const double since = tick % 2 == 0 ? 0.0 : 1e-3;
    const ToolWorld& seen = past.front();
    const Vec3 f = coupling.force({hand.x, 0, 0}, {seen.x + since * seen.v, 0, 0}, {seen.v, 0, 0}, 1e-3);
    run.peak_slew = std::max(run.peak_slew, std::abs(f.x() - force) / 1e-3);
    force = f.x();
    run.peak_force = std::max(run.peak_force, std::abs(force));
    const double before = hand.x;
    hand.advance(wanted, force, 1e-3);
    given += force * (hand.x - before);
    run.most_delivered = std::max(run.most_delivered, given);
    if (tick % 2 == 1) {
      world.step(hand.x);
      past.pop_front();
      past.push_back(world);
    }
    const int window = t > 3.5 ? 1 : (t > 2.2 && t < 2.7 ? 0 : -1);
    if (window >= 0) {
      low[window] = std::min(low[window], hand.x);
      high[window] = std::max(high[window], hand.x);
    }
  }
  run.early_swing = high[0] - low[0];
  run.last_swing = high[1] - low[1];
  run.held_back = coupling.held_back();
  return run;
}

struct Worst {
  double delivered = 0.0, swing = 0.0;
  std::uint64_t held_back = 0;
};

/// Hands from limp to clenched, light and heavy, against soft and hard walls.
Worst all_hands(const HandCouplingOptions& options, std::size_t delay) {
  Worst worst;
  for (double mass : {0.05, 0.1, 0.3}) {
    for (double stiffness : {50.0, 200.0, 600.0, 2000.0}) {
      for (double wall : {100.0, 2000.0, 50'000.0}) {
        const Outcome o =
            press_a_wall({mass, stiffness, 0.2 * std::sqrt(mass * stiffness)}, wall, options, delay);
        worst.delivered = std::max(worst.delivered, o.most_delivered);
        worst.swing = std::max(worst.swing, o.last_swing);
        worst.held_back += o.held_back;
        EXPECT_LE(o.peak_force, options.force_limit + 1e-12);
      }
    }
  }
  std::printf(
      "delay %2zu ms, tank %4.1f mJ: most energy given beyond what was taken %8.1f uJ, swing at rest %7.1f "
      "um, held back %llu\n",
      2 * delay, options.tank_start * 1e3, worst.delivered * 1e6, worst.swing * 1e6,
      static_cast<unsigned long long>(worst.held_back));
  return worst;
}

TEST(HandCoupling, IsPassiveAndQuietOnEveryHand) {
  const HandCouplingOptions options;
  const Worst worst = all_hands(options, 0);
  EXPECT_LE(worst.delivered, options.tank_start + 2e-5);
  EXPECT_LE(worst.swing, 1e-4);
}

TEST(HandCoupling, StaysPassiveWhenTheWorldIsLate) {
  const HandCouplingOptions options;
  for (std::size_t delay : {2u, 5u, 10u, 20u})
    EXPECT_LE(all_hands(options, delay).delivered, options.tank_start + 2e-5);
}

// The same spring without a tank does hand out energy: the test above can fail.
TEST(HandCoupling, WithoutItsTankItWouldNotBePassive) {
  HandCouplingOptions open;
  open.tank_start = open.tank_size = 1e9;
  EXPECT_GT(all_hands(open, 10).delivered, 1e-3);
}

TEST(HandCoupling, GivesTheScenesForceInNewtonsAtRest) {
  HandCoupling coupling;
  Vec3 force;
  // The instruments' coupling is in balance with 0.2 N on the tool when the tip lags by 0.2 N / (500 N/m).
  for (int i = 0; i < 100; ++i) force = coupling.force({0, 0, 0}, {0, 0, 0.4e-3}, Vec3::Zero(), 1e-3);
  EXPECT_NEAR((force - Vec3(0, 0, 0.2)).norm(), 0.0, 1e-12);
}

TEST(HandCoupling, ForceAndItsRateStayWithinTheirLimits) {
  const HandCouplingOptions options;
  HandCoupling coupling(options);
  Vec3 last = Vec3::Zero();
  for (int i = 0; i < 400; ++i) {
    // The tool is thrown about, the hand stands still.
    const Vec3 tool = (i / 50) % 2 == 0 ? Vec3(0.05, 0, 0) : Vec3(0, -0.05, 0.05);
    const Vec3 force = coupling.force(Vec3::Zero(), tool, Vec3::Zero(), 1e-3);
    ASSERT_LE(force.norm(), options.force_limit + 1e-12);
    ASSERT_LE((force - last).norm(), options.slew_limit * 1e-3 + 1e-12);
    last = force;
  }
  EXPECT_NEAR(last.norm(), options.force_limit, 1e-9);
  EXPECT_EQ(coupling.held_back(), 0u);
}

TEST(HandCoupling, ReleaseIsImmediateAndTheNextForceStartsFromZero) {
  HandCoupling coupling;
  for (int i = 0; i < 50; ++i) coupling.force(Vec3::Zero(), {2e-3, 0, 0}, Vec3::Zero(), 1e-3);
  coupling.release();
  const double tank = coupling.tank();
  const Vec3 force =
      coupling.force({0.1, 0, 0}, {0.102, 0, 0}, Vec3::Zero(), 1e-3);  // the hand is elsewhere now
  EXPECT_LE(force.norm(), 200.0 * 1e-3 + 1e-12);
  EXPECT_EQ(coupling.tank(), tank) << "a jump of the pose is no work";
}

TEST(HandCoupling, TheTankKeepsExactAccounts) {
  HandCouplingOptions options;
  options.tank_size = 1.0;
  HandCoupling coupling(options);
  double balance = options.tank_start;
  Vec3 force = Vec3::Zero(), hand = Vec3::Zero();
  for (int i = 0; i < 1000; ++i) {
    const Vec3 next(3e-3 * std::sin(0.05 * i), 1e-3 * std::cos(0.03 * i), 0);
    if (i > 0) balance -= force.dot(next - hand);
    hand = next;
    force = coupling.force(hand, {0, 0, 1e-3}, Vec3::Zero(), 1e-3);
    ASSERT_NEAR(coupling.tank(), balance, 1e-12);
  }
}

}  // namespace hand_coupling_test
}  // namespace filum
