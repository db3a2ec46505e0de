// From a recording on disk to the report: a hand with a known tremor, a scene at a tenth of its size.
#include "analysis/report.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "tests/session/synthetic.h"

namespace filum {
namespace report_test {

constexpr double kAmplitude = 40e-6, kTremor = 9.0;  // [m], [Hz]
constexpr double kScale = 0.1;                       // scene over hand
constexpr double kSeconds = 44.0;

struct Session {
  std::string input = "serial /dev/ttyACM0";
  double amplitude = kAmplitude, noise = 0.2e-6, force = 0.3;
  bool drop_samples = false;
  double lost_from = 0.0, lost_to = 0.0;  // [s], nothing of the device arrives
  bool replugged = false;                 // the device's clock begins anew after that
  double slow = 1.0;                      // host seconds for one of the scene
  unsigned seed = 1;
};

Vec3 hand_at(const Session& s, double t, std::mt19937& random) {
  std::normal_distribution<double> normal(0.0, s.noise);
  const Vec3 noise(normal(random), normal(random), normal(random));
  return Vec3(s.amplitude * std::sin(2.0 * std::numbers::pi * kTremor * t), 0.0, 5e-3) + noise;
}

RecorderOptions options_of(const std::string& file, const Session& s) {
  RecorderOptions o;
  o.file = file;
  o.meta.program = "filum test";
  o.meta.task = "tip-hold";
  o.meta.input = s.input;
  o.meta.dt = 0.002;
  o.meta.n_tools = 1;
  o.step_capacity = o.sample_capacity = 65536;
  return o;
}

void record(const std::string& file, const Session& s) {
  Recorder recorder(options_of(file, s));
  std::mt19937 random(s.seed);
  const std::int64_t host_offset = 700'000;  // [us], the host's clock started earlier than the scene's
  Vec3 hand = Vec3::Zero();
  for (int ms = 1; ms <= static_cast<int>(kSeconds * 1000); ++ms) {
    const double t = 1e-3 * ms;
    hand = hand_at(s, t, random);
    SampleRecord sample;
    const auto host_us = static_cast<std::int64_t>(1000 * s.slow * ms) + host_offset;
    sample.host_time_us = host_us;
    sample.device_time_us = host_us + (s.replugged && t > s.lost_to ? -10'000'000 : 123'456'789);
    sample.has_pose = sample.has_grip_force = true;
    sample.X_WD.p = hand;
    sample.grip_force = t > 20.0 && t < 24.0 ? s.force : 0.0;
    const bool lost = (s.drop_samples && ms % 5000 < 5) || (t > s.lost_from && t <= s.lost_to);
    if (!lost) recorder.record_sample(sample);
    if (ms % 2 == 0) {
      StepRecord step;
      step.step = static_cast<std::uint64_t>(ms / 2);
      step.host_time_us = host_us;
      step.inputs.tools[0].valid = true;
      step.inputs.tools[0].X_WD.p = kScale * hand;
      ASSERT_TRUE(recorder.record_step(step));
    }
    const auto at = static_cast<std::uint64_t>(ms / 2);
    if (ms == 2000) recorder.record_event({at, t, "hold-begun", 0, 1.0, "-"});
    if (ms == 42000) recorder.record_event({at, t, "hold-done", 0, 1.0, "-"});
    if (ms == 20500) recorder.record_event({at, t, "object-taken", 0, 0.1, "N"});
    if (ms == 23500) recorder.record_event({at, t, "object-slipped", 0, 0.1, "N"});
    if (ms % 1000 == 0) recorder.record_event({at, t, "target-error", 0, 1e-5 * (1.0 + 0.1 * (ms / 1000 % 7)), "m"});
  }
  ASSERT_TRUE(recorder.close()) << recorder.status().message;
}

RecordedSession read(const std::string& file) { return read_session(RecordingReader(file)); }

TEST(Report, HandAndSceneAreKeptApartAndResolvedAgainstTheClampedTool) {
  synthetic::Folder folder;
  record(folder.file("hand.rec"), {});
  Session still;
  still.amplitude = 0.0;
  still.seed = 2;
  record(folder.file("clamped.rec"), still);
  AnalysisInput input;
  input.sessions.push_back(read(folder.file("hand.rec")));
  input.clamped = read(folder.file("clamped.rec"));
  const auto json = analyse(input, "filum 1").json;
  ASSERT_EQ(json["tremor"].size(), 2u);
  for (const auto& t : json["tremor"]) {
    EXPECT_EQ(t["window"], "hold 1");
    EXPECT_NEAR(t["seconds"].get<double>(), 40.0, 0.1);
    ASSERT_TRUE(t["resolved"].get<bool>()) << t.dump();
    EXPECT_NEAR(t["peak_hz"].get<double>(), kTremor, 0.05);
    const double scale = t["space"] == "hand" ? 1.0 : kScale;
    EXPECT_NEAR(t["bands"][2]["rms_m"].get<double>(), scale * kAmplitude / std::numbers::sqrt2, 0.02 * scale * kAmplitude);
    EXPECT_GT(t["bands"][2]["noise_floor_rms_m"].get<double>(), 0.0);
  }
  EXPECT_EQ(json["derived_with"], "filum 1");
  EXPECT_EQ(json["settings"]["segment_s"], 4.0);
}

TEST(Report, WithoutAClampedToolTremorIsRefusedAndAScriptIsExact) {
  synthetic::Folder folder;
  record(folder.file("hand.rec"), {});
  Session scripted;
  scripted.input = "demonstrator";
  scripted.noise = 0.0;
  record(folder.file("script.rec"), scripted);
  AnalysisInput input;
  input.sessions = {read(folder.file("hand.rec"))};
  auto json = analyse(input, "filum").json;
  EXPECT_FALSE(json["tremor"][0]["resolved"].get<bool>());
  EXPECT_TRUE(json["tremor"][0]["bands"][2]["rms_m"].is_null());
  EXPECT_NE(json["tremor"][0]["why"].get<std::string>().find("--clamped"), std::string::npos);
  input.sessions = {read(folder.file("script.rec"))};
  json = analyse(input, "filum").json;
  EXPECT_TRUE(json["tremor"][0]["resolved"].get<bool>());
  EXPECT_EQ(json["tremor"][0]["noise_floor"], "zero: a script has no sensor");
}

TEST(Report, GraspForceHasItsExcessAndErrorsNeedExperts) {
  synthetic::Folder folder;
  Session strong;
  strong.force = 0.8;
  record(folder.file("novice.rec"), strong);
  record(folder.file("expert.rec"), {});
  AnalysisInput input;
  input.sessions = {read(folder.file("novice.rec"))};
  auto grasp = analyse(input, "filum").json["grasp_force"][0];
  EXPECT_EQ(grasp["source"], "device");
  ASSERT_EQ(grasp["grasps"], 1);
  EXPECT_NEAR(grasp["each"][0]["peak_n"].get<double>(), 0.8, 1e-12);
  EXPECT_NEAR(grasp["each"][0]["excess_over_slip_limit_n"].get<double>(), 0.7, 1e-12);
  EXPECT_TRUE(grasp["each"][0]["slipped"].get<bool>());
  EXPECT_TRUE(grasp["errors"].contains("why"));
  input.reference = {read(folder.file("expert.rec"))};
  grasp = analyse(input, "filum").json["grasp_force"][0];
  EXPECT_EQ(grasp["errors"]["high"], 1);
}

/// The only grasp of a session that is otherwise as above.
nlohmann::ordered_json only_grasp(const Session& s) {
  synthetic::Folder folder;
  record(folder.file("a.rec"), s);
  AnalysisInput input;
  input.sessions = {read(folder.file("a.rec"))};
  const auto force = analyse(input, "filum").json["grasp_force"][0];
  EXPECT_EQ(force["grasps"], 1);
  return force["grasps"] == 1 ? force["each"][0] : nlohmann::ordered_json();
}

TEST(Report, AGraspIsFoundAtTheScenesTimeWhateverTheDevicesClockDid) {
  for (const auto& [what, session] : std::vector<std::pair<const char*, Session>>{{"frames lost", {.lost_from = 5.0, .lost_to = 12.0}},
                                                                                 {"here and there, too", {.drop_samples = true, .lost_from = 5.0, .lost_to = 12.0}},
                                                                                 {"unplugged and plugged in again", {.lost_from = 5.0, .lost_to = 12.0, .replugged = true}},
                                                                                 {"at half the speed", {.slow = 2.0}},
                                                                                 {"both", {.lost_from = 5.0, .lost_to = 12.0, .slow = 2.0}}}) {
    SCOPED_TRACE(what);
    const auto grasp = only_grasp(session);
    ASSERT_FALSE(grasp.is_null());
    EXPECT_NEAR(grasp["from_s"].get<double>(), 20.0, 0.01);
    EXPECT_NEAR(grasp["to_s"].get<double>(), 24.0, 0.01);
    ASSERT_FALSE(grasp["excess_over_slip_limit_n"].is_null()) << "the object was held from 20.5 to 23.5 s";
    EXPECT_NEAR(grasp["excess_over_slip_limit_n"].get<double>(), 0.2, 1e-12);
    EXPECT_TRUE(grasp["slipped"].get<bool>());
  }
}

TEST(Report, LossesAreGapsAndSessionsAreCorrelated) {
  synthetic::Folder folder;
  AnalysisInput input;
  for (unsigned i = 0; i < 4; ++i) {
    Session s;
    s.seed = i + 1;
    s.drop_samples = i == 0;
    s.force = 0.2 + 0.1 * i;
    s.amplitude = kAmplitude * (1.0 + 0.5 * i);
    const std::string file = folder.file("s" + std::to_string(i) + ".rec");
    record(file, s);
    input.sessions.push_back(read(file));
  }
  EXPECT_EQ(analyse(input, "filum").json["correlation"]["force_tremor"]["across"]["n"], 0) << "tremor that is not resolved";
  Session still;
  still.amplitude = 0.0;
  still.seed = 9;
  record(folder.file("clamped.rec"), still);
  input.clamped = read(folder.file("clamped.rec"));
  const AnalysisReport report = analyse(input, "filum");
  EXPECT_EQ(report.json["sessions"].size(), 4u);
  EXPECT_EQ(report.json["sessions"][0]["tremor"][0]["gaps"], 8);
  EXPECT_EQ(report.json["sessions"][1]["tremor"][0]["gaps"], 0);
  const auto across = report.json["correlation"]["force_tremor"]["across"];
  EXPECT_EQ(across["n"], 4);
  EXPECT_GT(across["r"].get<double>(), 0.99);
  EXPECT_EQ(report.panels.size(), 3u);
}

}  // namespace report_test
}  // namespace filum
