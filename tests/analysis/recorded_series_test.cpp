// From a recording on disk to paths, forces and windows, by the clock that each of them has.
#include "analysis/recorded_series.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "tests/session/synthetic.h"

namespace filum {
namespace recorded_series_test {

constexpr std::int64_t kOffset = 5'000'000;  // [us], the host's clock over the scene's
constexpr int kSamples = 2000;               // one each millisecond

struct Made {
  std::string input = "serial /dev/ttyACM0";
  std::function<void(int, SampleRecord&)> change = [](int, SampleRecord&) {};
  std::vector<EventRecord> events = {};
  double slow = 1.0;  // host seconds for one of the scene
};

RecordedSession recorded(const Made& m) {
  synthetic::Folder folder;
  RecorderOptions o;
  o.file = folder.file("a.rec");
  o.meta.program = "test";
  o.meta.task = "tip-hold";
  o.meta.input = m.input;
  o.meta.dt = 0.002;
  o.meta.n_tools = 2;
  o.step_capacity = o.sample_capacity = 16384;
  Recorder recorder(o);
  const bool scripted = m.input == "demonstrator";
  for (int ms = 1; ms <= kSamples; ++ms) {
    SampleRecord s;
    s.tool = 1;
    s.host_time_us = 1000 * ms + (scripted ? 0 : kOffset);
    s.device_time_us = 1000 * ms + 99;
    s.has_pose = s.has_grip_force = true;
    s.X_WD.p = Vec3(1e-3 * ms, 0.0, 0.0);
    s.grip_force = 1e-3 * ms;
    m.change(ms, s);
    recorder.record_sample(s);
    if (ms % 2 != 0) continue;
    StepRecord step;
    step.step = static_cast<std::uint64_t>(ms / 2);
    step.host_time_us = static_cast<std::int64_t>(1000 * m.slow * ms) + kOffset;
    step.inputs.tools[1].valid = ms > 1000;
    step.inputs.tools[1].X_WD.p = Vec3(1e-4 * ms, 0.0, 0.0);
    EXPECT_TRUE(recorder.record_step(step));
  }
  for (const EventRecord& e : m.events) recorder.record_event(e);
  EXPECT_TRUE(recorder.close()) << recorder.status().message;
  return read_session(RecordingReader(o.file));
}

TEST(RecordedSeries, HandAndSceneKeepTheirOwnClocks) {
  const RecordedSession s = recorded({});
  EXPECT_DOUBLE_EQ(s.seconds, 2.0);
  ASSERT_EQ(s.tools.size(), 1u) << "the tool that nobody moved is left out";
  const ToolSeries& t = s.tools[0];
  EXPECT_EQ(t.tool, 1);
  ASSERT_EQ(t.hand.clock.size(), 2000u);
  EXPECT_NEAR(t.hand.clock[499], 0.5 + 99e-6, 1e-9);  // the device's
  EXPECT_NEAR(t.hand.scene[499], 0.5, 1e-9);          // of the scene, by the host's
  EXPECT_DOUBLE_EQ(t.hand.p(0, 499), 0.5);
  ASSERT_EQ(t.scene.clock.size(), 500u) << "steps in which the tool was not valid are left out";
  EXPECT_DOUBLE_EQ(t.scene.clock[0], 1.002);
  EXPECT_DOUBLE_EQ(t.scene.p(0, 0), 1e-4 * 1002);
}

TEST(RecordedSeries, AScriptIsStampedWithTheScenesOwnTime) {
  EXPECT_NEAR(recorded({.input = "demonstrator"}).tools[0].hand.scene[499], 0.5, 1e-9);
}

TEST(RecordedSeries, AClockThatRestartsLosesHalfASecondAndMixesNothing) {
  const RecordedSession s = recorded({.change = [](int ms, SampleRecord& r) {
    if (ms > 1200) r.device_time_us -= 1'200'000;
  }});
  const std::vector<double>& clock = s.tools[0].hand.clock;
  ASSERT_NEAR(static_cast<double>(clock.size()), 1501.0, 1.0);
  EXPECT_NEAR(clock[1200] - clock[1199], 0.5, 1.1e-3);
  EXPECT_TRUE(std::is_sorted(clock.begin(), clock.end()));
}

TEST(RecordedSeries, AfterASilenceAClockThatBeganAnewGoesOnByTheScenes) {
  const RecordedSession s = recorded({.change = [](int ms, SampleRecord& r) {
    if (ms > 400) r.device_time_us -= 400'000;  // at 800 ms it would say what it said at 400: seen as one, the two parts would be mixed
    if (ms > 300 && ms <= 900) r.has_pose = r.has_grip_force = false;
  }});
  const ToolSeries& t = s.tools[0];
  ASSERT_EQ(t.hand.clock.size(), 1400u);
  ASSERT_EQ(t.grip.clock.size(), 1400u);
  for (const std::vector<double>& clock : {t.hand.clock, t.grip.clock}) {
    EXPECT_NEAR(clock[300] - clock[299], 0.601, 1e-6) << "the silence is a gap of its length";
    EXPECT_NEAR(clock[301] - clock[300], 0.001, 1e-9);
  }
}

TEST(RecordedSeries, SceneTimeNeverRunsBackWhereStepsComeLate) {
  const RecordedSession s = recorded({.change = [](int, SampleRecord& r) { r.host_time_us = kOffset + 3 * (r.host_time_us - kOffset); }, .slow = 3.0});
  const ToolSeries& t = s.tools[0];
  EXPECT_TRUE(std::is_sorted(t.hand.scene.begin(), t.hand.scene.end())) << "windows are cut by it";
  EXPECT_NEAR(t.hand.scene[999], 1.0, 2.1e-3);
}

TEST(RecordedSeries, ForcesSayWhetherTheyCanBeBelieved) {
  const ToolSeries fine = recorded({}).tools[0];
  EXPECT_EQ(fine.grip.source, "device");
  EXPECT_FALSE(fine.grip.foreign);
  EXPECT_EQ(fine.grip.saturated, 0u);
  const ToolSeries doubtful = recorded({.change = [](int ms, SampleRecord& r) {
    r.buttons = ms == 7 ? 0x1000 : ms > 1990 ? 0x200 : 0;
  }}).tools[0];
  EXPECT_TRUE(doubtful.grip.foreign);
  EXPECT_EQ(doubtful.grip.saturated, 10u);
  EXPECT_EQ(recorded({.change = [](int, SampleRecord& r) { r.has_grip_force = false; }}).tools[0].grip.source, "none");
}

TEST(RecordedSeries, WindowsAreThoseThatWereEndedAndObjectsThoseOfTheTool) {
  const ToolSeries t = recorded({.events = {{100, 0.2, "hold-begun", 1, 1.0, "-"}, {400, 0.8, "hold-done", 1, 1.0, "-"}, {500, 1.0, "hold-begun", 1, 2.0, "-"},
                                            {200, 0.4, "object-taken", 1, 0.05, "N"}, {300, 0.6, "object-slipped", 1, 0.05, "N"}, {310, 0.62, "object-taken", 0, 0.05, "N"},
                                            {350, 0.7, "target-error", 1, 2e-4, "m"}}}).tools[0];
  ASSERT_EQ(t.holds.size(), 1u) << "one was begun and not done";
  EXPECT_EQ(t.holds[0].name, "hold 1");
  EXPECT_DOUBLE_EQ(t.holds[0].from, 0.2);
  EXPECT_DOUBLE_EQ(t.holds[0].to, 0.8);
  ASSERT_EQ(t.held.size(), 1u) << "the other tool's object is not this one's";
  EXPECT_TRUE(t.held[0].slipped);
  EXPECT_DOUBLE_EQ(t.held[0].to, 0.6);
  ASSERT_EQ(t.target_error.size(), 1u);
  EXPECT_DOUBLE_EQ(t.target_error[0][1], 2e-4);
}

TEST(RecordedSeries, APathIsCutBySceneTime) {
  const TimedPath part = recorded({}).tools[0].hand.cut(0.5, 1.0);
  ASSERT_EQ(part.clock.size(), 501u);
  EXPECT_EQ(part.p.cols(), 501);
  EXPECT_NEAR(part.clock.front(), 0.5 + 99e-6, 1e-9);
  EXPECT_TRUE(recorded({}).tools[0].hand.cut(3.0, 4.0).clock.empty());
}

}  // namespace recorded_series_test
}  // namespace filum
