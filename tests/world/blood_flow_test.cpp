#include "world/blood_flow.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string_view>

#include "world/join_test.h"
#include "world/model.h"
#include "world/state.h"
#include "world/world.h"

namespace filum {
namespace blood_flow_test {

constexpr double kMmHg = 133.322;

std::shared_ptr<const Model> stumps() {
  static const auto model = load_model(FILUM_SOURCE_DIR, "vessel-stitch");
  return model;
}

/// Steps for so many seconds; the names of what happened.
std::vector<std::string> steps(World& w, const Inputs& in, double seconds) {
  std::vector<std::string> names;
  for (int k = 0; k < static_cast<int>(seconds / w.description().dt); ++k) {
    w.step(in);
    const Observation& o = w.observation();
    for (int e = 0; e < o.n_events; ++e) names.emplace_back(o.events[static_cast<std::size_t>(e)].name);
  }
  return names;
}

int count(const std::vector<std::string>& names, std::string_view name) { return static_cast<int>(std::count(names.begin(), names.end(), name)); }

Inputs pressing(std::uint32_t buttons) {
  Inputs in;
  in.tools[0].valid = true;
  in.tools[0].X_WD = stumps()->instrument_start[0];
  in.tools[0].buttons = buttons;
  return in;
}

TEST(BloodFlow, UpstreamFirstFillsTheVesselToWhatTheArteryGives) {
  World w(stumps());
  EXPECT_TRUE(w.observation().tissue.blood.present);
  EXPECT_FALSE(w.observation().tissue.blood.off[0]);
  auto seen = steps(w, pressing(8), 0.05);
  EXPECT_EQ(count(seen, "clamp-off"), 1);
  seen = steps(w, pressing(16), 0.3);
  EXPECT_EQ(count(seen, "clamp-off"), 1);
  EXPECT_EQ(count(seen, "clamps-wrong-order"), 0);
  const BloodObservation& b = w.observation().tissue.blood;
  EXPECT_TRUE(b.off[0] && b.off[1]);
  const Circulation c;
  EXPECT_LT(b.leaks, c.cut_flow);
  EXPECT_GT(b.leaks, 0.95 * c.cut_flow) << "a cut 0.6 mm wide lets out what the artery gives, but for the stump's own resistance";
  EXPECT_LT(b.pressure[0], 10.0 * kMmHg);
  EXPECT_NEAR(b.lost, 0.35 * c.cut_flow, 0.1 * c.cut_flow);
  for (const double q : b.leak) EXPECT_NEAR(q, b.leaks / 8.0, 0.3 * b.leaks / 8.0) << "all round";
}

TEST(BloodFlow, DownstreamFirstIsNoted) {
  World w(stumps());
  const auto seen = steps(w, pressing(16), 0.02);
  EXPECT_EQ(count(seen, "clamps-wrong-order"), 1);
  EXPECT_TRUE(w.observation().tissue.blood.wrong_order);
  steps(w, pressing(0), 0.1);
  EXPECT_LT(w.observation().tissue.blood.pressure[1], 26.0 * kMmHg) << "collaterals";
}

/// A vein that a scene holds empty by suction (`slack`) and whose clamp comes off: what is lost grows from nothing on.
TEST(BloodFlow, NoneComesBackIntoAnEmptyVein) {
  World w(load_model(FILUM_SOURCE_DIR, "anastomosis-vein"));
  State s = w.state();
  s.tissue.pressure.fill(-15.0 * kMmHg);
  w.restore(s);
  Inputs in;
  in.tools[0] = {w.model().instrument_start[0], 0.0, 0.0, false, true, 8};
  double least = 0.0;
  for (int k = 0; k < 12; ++k) {
    w.step(in);
    least = std::min(least, w.observation().tissue.blood.lost);
  }
  EXPECT_GE(least, 0.0) << "[m3]";
}

TEST(BloodFlow, SameAfterRestoreAndWithoutAllClampsOnAsBefore) {
  World a(stumps()), b(stumps());
  steps(a, pressing(8), 0.02);
  const State middle = a.state();
  steps(a, pressing(24), 0.04);
  b.restore(middle);
  steps(b, pressing(24), 0.04);
  EXPECT_EQ(a.state_hash(), b.state_hash());
  const JoinTestReport with = join_test(*stumps(), a.state());
  EXPECT_TRUE(with.sound) << "the test at the end is held at its own pressure, whatever is off";
  EXPECT_GT(with.leak, 100.0 / 60e6);
}

/// What flows is told of the state that is seen, not of one before.
TEST(BloodFlow, RestoredWithItsClampsOnNothingFlows) {
  World w(stumps());
  const State first = w.state();
  steps(w, pressing(24), 0.04);
  const BloodObservation& b = w.observation().tissue.blood;
  ASSERT_GT(b.leaks, 0.0);
  w.restore(first);
  EXPECT_FALSE(b.off[0]);
  EXPECT_EQ(b.leaks, 0.0);
  EXPECT_EQ(b.through, 0.0);
  for (const double q : b.leak) EXPECT_EQ(q, 0.0);
}

/// Jaws that come down open over the clamp's arms and close.
TEST(BloodFlow, ForcepsOpenAClamp) {
  World w(stumps());
  const Pose clamp = clamp_pose(*stumps()->vessel, w.state().tissue.clamp, 0);
  Inputs in;
  ToolInput& t = in.tools[1];
  t.valid = true;
  t.X_WD = stumps()->instrument_start[1];
  t.X_WD.p = clamp * Vec3(0, clamp_arms(*stumps()->vessel).reach - 0.4e-3, 0);
  t.grip_angle = 0.2;
  EXPECT_EQ(count(steps(w, in, 0.4), "clamp-off"), 0);
  t.grip_angle = -0.05;
  EXPECT_EQ(count(steps(w, in, 0.2), "clamp-off"), 1);
  EXPECT_TRUE(w.observation().tissue.blood.off[0]);
  EXPECT_FALSE(w.observation().tissue.blood.off[1]);
}

/// Two forceps over the second stump, jaws on either side of it, each leaning away from the other.
class TwoForceps {
 public:
  explicit TwoForceps(World& w) : world_(w) {
    for (std::size_t i = 0; i < 2; ++i) {
      in.tools[i].valid = true;
      in.tools[i].X_WD = {Vec3(0, 1.0e-3 + 0.3e-3 * static_cast<double>(i), 4e-3), Quat(Eigen::AngleAxisd(i == 0 ? 0.4 : -0.4, Vec3::UnitX()))};
      in.tools[i].grip_angle = 0.3;
    }
    steps(w, in, 0.2);
    move([this](double f) { for (std::size_t i = 0; i < 2; ++i) in.tools[i].X_WD.p.z() = 4e-3 - 4.8e-3 * f; }, 0.2);
  }
  template <class Change>
  std::vector<std::string> move(Change change, double seconds) {
    std::vector<std::string> all;
    for (int k = 1; k <= 10; ++k) {
      change(k / 10.0);
      const auto seen = steps(world_, in, seconds / 10.0);
      all.insert(all.end(), seen.begin(), seen.end());
    }
    return all;
  }
  Inputs in;

 private:
  World& world_;
};

TEST(BloodFlow, ForcepsPressTheVesselShutStripItAndLetGo) {
  World w(stumps());
  TwoForceps hands(w);
  hands.in.tools[0].buttons = 24;
  steps(w, hands.in, 0.1);
  const auto blood = [&]() -> const BloodObservation& { return w.observation().tissue.blood; };
  const double open = blood().least_area;
  hands.move([&](double f) { for (std::size_t i = 0; i < 2; ++i) hands.in.tools[i].grip_angle = 0.3 - 0.35 * f; }, 0.25);
  EXPECT_LT(blood().least_area, 0.6 * open) << "jaws press the vessel";
  EXPECT_EQ(blood().milking, Milking::stripping);
  hands.move([&](double f) { hands.in.tools[1].X_WD.p.y() = 1.3e-3 + 0.8e-3 * f; }, 0.2);
  EXPECT_NEAR((blood().empty_to - blood().empty_from), 0.8e-3, 0.2e-3);
  hands.in.tools[0].buttons = 0;
  const auto seen = hands.move([&](double f) { hands.in.tools[0].grip_angle = -0.05 + 0.35 * f; }, 0.1);
  EXPECT_EQ(count(seen, "milking-let-go"), 1);
  EXPECT_EQ(count(seen, "milking-refilled"), 0) << "the cut is open: no pressure behind it";
}

}  // namespace blood_flow_test
}  // namespace filum
