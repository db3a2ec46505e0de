#include "devices/demonstrator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "devices/sample_faults.h"

namespace filum {
namespace demonstrator_test {

const char* kScript = R"(
format: filum-demonstration/1
title: Two hands
tools:
  - tool: 0
    keys:
      - { t: "0 s", p: ["0 mm", "0 mm", "0 mm"], handle: [0, 0, 1], opening: [1, 0, 0], grip: "0 deg" }
      - { t: "1 s", p: ["5 mm", "0 mm", "0 mm"], grip: "20 deg" }
  - tool: 1
    keys:
      - { t: "0 s", p: ["9 mm", "0 mm", "0 mm"], handle: [0, 0, 1], opening: [1, 0, 0], grip: "5 deg" }
)";

std::vector<DeviceSample> play(Demonstrator& device, std::int64_t step_us, std::int64_t end_us) {
  std::vector<DeviceSample> all, out;
  for (std::int64_t now = 0; now <= end_us; now += step_us) {
    out.clear();
    device.poll(now, out);
    EXPECT_LE(out.size(), kMaxSamplesPerPoll);
    all.insert(all.end(), out.begin(), out.end());
  }
  return all;
}

TEST(Demonstrator, SamplesDoNotDependOnWhenItIsPolled) {
  const PoseScript script = PoseScript::parse(kScript, "two.yaml");
  Demonstrator often(script), seldom(script);
  const auto a = play(often, 500, 1'000'000), b = play(seldom, 50'000, 1'000'000);
  ASSERT_EQ(a.size(), 2u * 1001u);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].tool, b[i].tool);
    EXPECT_EQ(a[i].host_time_us, b[i].host_time_us);
    EXPECT_EQ(a[i].X_WD.p, b[i].X_WD.p);
    EXPECT_EQ(a[i].sequence, b[i].sequence);
  }
  EXPECT_EQ(often.health().lost, 0u);
  EXPECT_EQ(often.health().received, a.size());
}

TEST(Demonstrator, GivesThePosesOfTheScript) {
  const PoseScript script = PoseScript::parse(kScript, "two.yaml");
  Demonstrator device(script);
  for (const DeviceSample& sample : play(device, 1000, 1'000'000)) {
    const DeviceSample expected = script.at(sample.tool, static_cast<double>(sample.host_time_us) * 1e-6);
    EXPECT_EQ(sample.X_WD.p, expected.X_WD.p);
    EXPECT_EQ(sample.grip_angle, expected.grip_angle);
    EXPECT_TRUE(sample.has_pose && sample.has_grip_angle);
  }
}

TEST(Demonstrator, ALateCallerGetsTheNewestAndTheRestIsCounted) {
  Demonstrator device(PoseScript::parse(kScript, "two.yaml"));
  std::vector<DeviceSample> out;
  device.poll(900'000, out);
  ASSERT_FALSE(out.empty());
  EXPECT_LE(out.size(), kMaxSamplesPerPoll);
  EXPECT_EQ(out.back().host_time_us, 900'000);
  EXPECT_EQ(device.health().received + device.health().lost, 2u * 901u);
}

TEST(Demonstrator, FinishesAfterTheLastKeyAndHoldsIt) {
  Demonstrator device(PoseScript::parse(kScript, "two.yaml"));
  std::vector<DeviceSample> out;
  EXPECT_EQ(device.health().state, DeviceState::waiting);
  device.poll(500'000, out);
  EXPECT_EQ(device.health().state, DeviceState::live);
  out.clear();
  device.poll(1'500'000, out);
  EXPECT_EQ(device.health().state, DeviceState::finished);
  for (const DeviceSample& s : out)
    if (s.tool == 0 && s.host_time_us > 1'000'000) {
      EXPECT_EQ(s.X_WD.p, Vec3(5e-3, 0, 0));
    }
}

const char* kLooking = R"(
format: filum-demonstration/1
title: A hand that looks
tools:
  - tool: 0
    keys:
      - { t: "0 s", p: ["9 mm", "0 mm", "0 mm"], handle: [0, 0, 1], opening: [1, 0, 0], grip: "0 deg" }
      - { t: "100 ms", p: ["5 mm", "0 mm", "0 mm"] }
      - { t: "200 ms", at: { thread: "1 mm", from: end }, p: ["0 mm", "0 mm", "2 mm"], handle: [0, 0, 1], opening: [1, 0, 0] }
      - { t: "300 ms", arc: { centre: ["0 mm", "0 mm", "0 mm"], axis: [1, 0, 0], turns: 0.25 } }
      - { t: "400 ms", at: { exit: 2, bring: "3 mm" }, p: ["0 mm", "0 mm", "1 mm"], handle: [0, 0, 1], opening: [0, 1, 0] }
      - { t: "500 ms", at: {}, p: ["1 mm", "1 mm", "1 mm"], handle: [0, 0, 1], opening: [1, 0, 0] }
  - tool: 1
    keys:
      - { t: "0 s", p: ["0 mm", "0 mm", "0 mm"], handle: [0, 0, 1], opening: [1, 0, 0], grip: "0 deg" }
      - { t: "500 ms", p: ["0 mm", "5 mm", "0 mm"] }
)";

/// Sees a thread (from the start, or later), the exit of way 2, its own tool and the needle in it.
struct MadeUpEyes final : Eyes {
  Pose thread{Vec3(1e-3, 2e-3, 3e-3), Quat(Eigen::AngleAxisd(0.5, Vec3::UnitZ()))};
  Pose tool{Vec3(0, 0, 7e-3), Quat(Eigen::AngleAxisd(0.3, Vec3::UnitX()))}, needle{Vec3(1e-3, 0, 7e-3), Quat(Eigen::AngleAxisd(-0.4, Vec3::UnitY()))};
  bool thread_there = true;
  mutable std::vector<Look> asked;
  bool find(const Look& look, Pose& X_WF) const noexcept override {
    asked.push_back(look);
    if (look.kind == Look::Kind::thread) X_WF = thread;
    if (look.kind == Look::Kind::exit) X_WF = {Vec3(0, 4e-3, 0), Quat::Identity()};
    if (look.kind == Look::Kind::tool) X_WF = tool;
    if (look.kind == Look::Kind::needle) X_WF = needle;
    return look.kind != Look::Kind::thread || thread_there;
  }
};

/// The newest pose of tool 0 when scene time `t_us` is reached.
Pose pose_at(const std::vector<DeviceSample>& samples, std::int64_t t_us) {
  for (const DeviceSample& s : samples)
    if (s.tool == 0 && s.host_time_us == t_us) return s.X_WD;
  ADD_FAILURE() << "no sample at " << t_us;
  return {};
}

TEST(Demonstrator, GoesWhereItSeesThingsWhenItSetsOut) {
  Demonstrator device(PoseScript::parse(kLooking, "looking.yaml"));
  MadeUpEyes eyes;
  device.look_through(&eyes);
  const auto samples = play(device, 1000, 500'000);
  ASSERT_EQ(eyes.asked.size(), 4u) << "once for the thread; for the exit, the needle and the tool that holds it";
  EXPECT_DOUBLE_EQ(eyes.asked[0].length, 1e-3);
  EXPECT_TRUE(eyes.asked[0].from_end);
  EXPECT_EQ(eyes.asked[1].index, 1);
  EXPECT_EQ(eyes.asked[2].holder, 0);
  EXPECT_NEAR((pose_at(samples, 100'000).p - Vec3(5e-3, 0, 0)).norm(), 0.0, 1e-15);
  EXPECT_NEAR((pose_at(samples, 200'000).p - eyes.thread * Vec3(0, 0, 2e-3)).norm(), 0.0, 1e-15);
  EXPECT_NEAR(pose_at(samples, 200'000).q.angularDistance(eyes.thread.q), 0.0, 1e-7);
  // A quarter of a turn about the thread's own direction, right-handed: from z to -y.
  EXPECT_NEAR((pose_at(samples, 300'000).p - eyes.thread * Vec3(0, -2e-3, 0)).norm(), 0.0, 1e-15);
  // The needle, held by the tool as seen, is at the exit with its normal up and its outward direction along y.
  const Pose X_WA = pose_at(samples, 400'000) * eyes.tool.inverse() * eyes.needle;
  EXPECT_NEAR((X_WA.p - Vec3(0, 4e-3, 1e-3)).norm(), 0.0, 1e-15);
  EXPECT_NEAR((X_WA.q * Vec3::UnitX() - Vec3::UnitY()).norm(), 0.0, 1e-12);
  EXPECT_NEAR((X_WA.q * Vec3::UnitZ() - Vec3::UnitZ()).norm(), 0.0, 1e-12);
  EXPECT_NEAR((pose_at(samples, 500'000).p - Vec3(1e-3, 1e-3, 1e-3)).norm(), 0.0, 1e-15);
}

TEST(Demonstrator, MovesWithoutAJumpWhereItLooks) {
  Demonstrator device(PoseScript::parse(kLooking, "looking.yaml"));
  MadeUpEyes eyes;
  device.look_through(&eyes);
  Pose before = device.script().at(0, 0.0).X_WD;
  for (const DeviceSample& s : play(device, 1000, 600'000)) {
    if (s.tool != 0) continue;
    EXPECT_LT((s.X_WD.p - before.p).norm(), 0.3e-3) << s.host_time_us;
    EXPECT_LT(s.X_WD.q.angularDistance(before.q), 0.05) << s.host_time_us;
    before = s.X_WD;
  }
}

TEST(Demonstrator, WaitsWithAllHandsForWhatIsNotThereAndSaysSo) {
  Demonstrator device(PoseScript::parse(kLooking, "looking.yaml"));
  MadeUpEyes eyes;
  eyes.thread_there = false;
  device.look_through(&eyes);
  std::vector<DeviceSample> out;
  for (std::int64_t now = 0; now <= 300'000; now += 1000) device.poll(now, out);
  for (const DeviceSample& s : out) {
    EXPECT_EQ((s.buttons & kNotSeen) != 0, s.tool == 0 && s.host_time_us >= 100'000) << s.tool << " at " << s.host_time_us;
    if (s.host_time_us >= 100'000) {
      EXPECT_NEAR((s.X_WD.p - (s.tool == 0 ? Vec3(5e-3, 0, 0) : device.script().at(1, 0.1).X_WD.p)).norm(), 0.0, 1e-15);
    }
  }
  eyes.thread_there = true;
  out.clear();
  for (std::int64_t now = 301'000; now <= 401'000; now += 1000) device.poll(now, out);
  EXPECT_EQ(out.front().buttons & kNotSeen, 0u);
  EXPECT_NEAR((pose_at(out, 401'000).p - eyes.thread * Vec3(0, 0, 2e-3)).norm(), 0.0, 1e-15);
}

const char* kPulling = R"(
format: filum-demonstration/1
title: A hand that pulls
tools:
  - tool: 0
    keys:
      - { t: "0 s", p: ["0 mm", "0 mm", "0 mm"], handle: [0, 0, 1], opening: [1, 0, 0], grip: "-4 deg" }
      - { t: "100 ms", p: ["1 mm", "0 mm", "0 mm"] }
      - { t: "500 ms", p: ["9 mm", "0 mm", "0 mm"], handle: [0, 1, 0], until: { pull: "15 mN" } }
      - { t: "600 ms", grip: "5 deg" }
      - { t: "700 ms", p: ["1 mm", "2 mm", "0 mm"] }
)";

/// A spring that hangs on tool 0 from x = 3 mm on; and a snap of half its reach in time.
struct SpringEyes final : Eyes {
  const std::vector<DeviceSample>* samples = nullptr;
  double stiffness = 10.0;  // [N/m]
  bool snaps = false;
  bool find(const Look&, Pose&) const noexcept override { return false; }
  double felt(int tool) const noexcept override {
    if (tool != 0 || samples->empty()) return 0.0;
    if (snaps && samples->back().host_time_us / 5000 % 2 == 0 && samples->back().X_WD.p.x() < 2e-3) return 1.0;
    return std::max(0.0, stiffness * (samples->back().X_WD.p.x() - 3e-3));
  }
};

std::vector<DeviceSample> pull(Demonstrator& device, SpringEyes& eyes) {
  std::vector<DeviceSample> out;
  out.reserve(2000);
  eyes.samples = &out;
  device.look_through(&eyes);
  for (std::int64_t now = 0; now <= 800'000; now += 1000) device.poll(now, out);
  return out;
}

TEST(Demonstrator, StopsWhereItFeelsThePullAndStaysForTheKeysThatGiveNoPlace) {
  for (const bool snaps : {false, true}) {
    Demonstrator device(PoseScript::parse(kPulling, "pulling.yaml"));
    SpringEyes eyes;
    eyes.snaps = snaps;
    const auto samples = pull(device, eyes);
    const Pose there = pose_at(samples, 500'000);
    // 15 mN at 4.5 mm; ten samples later, at 30 mm/s in the middle of the way, it has gone on by as much as 0.3 mm.
    EXPECT_GE(there.p.x(), 4.5e-3);
    EXPECT_LT(there.p.x(), 4.85e-3) << "snaps " << snaps;
    EXPECT_GT(there.q.angularDistance(pose_at(samples, 100'000).q), 0.1);
    EXPECT_LT(there.q.angularDistance(pose_at(samples, 100'000).q), 1.5) << "it does not go on turning";
    for (const std::int64_t t : {400'000, 550'000, 600'000}) {
      EXPECT_EQ(pose_at(samples, t).p, there.p) << t;
      EXPECT_LT((pose_at(samples, t).q.coeffs() - there.q.coeffs()).norm(), 1e-15) << t;  // between equal turns: rounding, by compiler
    }
    EXPECT_NEAR((pose_at(samples, 700'000).p - Vec3(1e-3, 2e-3, 0)).norm(), 0.0, 1e-15) << "and goes on from there";
    EXPECT_NEAR(samples.back().grip_angle, 5.0 / 57.29578, 1e-6);
    for (std::size_t i = 1; i < samples.size(); ++i) EXPECT_LT((samples[i].X_WD.p - samples[i - 1].X_WD.p).norm(), 0.07e-3) << i;
  }
}

TEST(Demonstrator, GoesAllTheWayWhereItFeelsTooLittle) {
  Demonstrator device(PoseScript::parse(kPulling, "pulling.yaml"));
  SpringEyes eyes;
  eyes.stiffness = 2.0;
  const auto samples = pull(device, eyes);
  EXPECT_NEAR((pose_at(samples, 600'000).p - Vec3(9e-3, 0, 0)).norm(), 0.0, 1e-15);
}

const char* kFollowing = R"(
format: filum-demonstration/1
title: A hand that follows
tools:
  - tool: 0
    keys:
      - { t: "0 s", p: ["9 mm", "0 mm", "0 mm"], handle: [0, 0, 1], opening: [1, 0, 0], grip: "0 deg" }
      - { t: "500 ms", at: { thread: "1 mm", from: end, axes: scene, follow: true }, p: ["0 mm", "0 mm", "2 mm"], handle: [0, 0, 1], opening: [1, 0, 0] }
      - { t: "1500 ms", p: ["0 mm", "0 mm", "0 mm"] }
      - { t: "1600 ms", at: {}, p: ["0 mm", "0 mm", "9 mm"], handle: [0, 0, 1], opening: [1, 0, 0] }
)";

TEST(Demonstrator, FollowsWhatMovesUntilItIsThere) {
  Demonstrator device(PoseScript::parse(kFollowing, "following.yaml"));
  MadeUpEyes eyes;
  eyes.thread = {Vec3(1e-3, 2e-3, 3e-3), Quat::Identity()};
  device.look_through(&eyes);
  std::vector<DeviceSample> out;
  for (std::int64_t now = 0; now <= 1'600'000; now += 1000) {
    if (now == 200'000) eyes.thread.p.x() += 1e-3;   // it jumps once
    if (now == 1'510'000) eyes.thread.p.x() += 1e-3;  // and when the hand is on its way elsewhere
    eyes.thread_there = now < 1'000'000;
    device.poll(now, out);
  }
  EXPECT_NEAR((pose_at(out, 500'000).p - Vec3(2e-3, 2e-3, 5e-3)).norm(), 1e-3 * std::exp(-3.0), 0.02e-3) << "lags by 0.1 s";
  EXPECT_NEAR((pose_at(out, 1'500'000).p - Vec3(2e-3, 2e-3, 3e-3)).norm(), 0.0, 1e-6) << "stays where it was last seen";
  EXPECT_NEAR((pose_at(out, 1'600'000).p - Vec3(0, 0, 9e-3)).norm(), 0.0, 1e-15);
  for (std::size_t i = 1; i < out.size(); ++i) EXPECT_LT((out[i].X_WD.p - out[i - 1].X_WD.p).norm(), 0.2e-3) << i;
}

TEST(Demonstrator, IsOverAfterTenSecondsInVain) {
  Demonstrator device(PoseScript::parse(kLooking, "looking.yaml"));  // has no eyes
  std::vector<DeviceSample> out;
  device.poll(10'000'000, out);
  for (std::int64_t now = 0; now <= 20'000'000 && device.health().state != DeviceState::finished; now += 10'000) {
    out.clear();
    device.poll(now, out);
  }
  EXPECT_EQ(device.health().state, DeviceState::finished);
}

}  // namespace demonstrator_test
}  // namespace filum
