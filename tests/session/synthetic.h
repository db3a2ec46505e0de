#pragma once
// Records made from a step number alone, so that a test can tell without any memory what must stand in a
// recording.

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <string>

#include "base/hash.h"
#include "session/recorder.h"
#include "session/records.h"

namespace filum::synthetic {

inline StepRecord step(std::uint64_t n) {
  StepRecord record;
  record.step = n;
  record.host_time_us = static_cast<std::int64_t>(n) * 2000 + 17;
  record.compute_us = static_cast<std::uint32_t>(n % 900);
  record.state_hash = hash_bytes(&n, sizeof n);
  for (std::size_t i = 0; i < 2; ++i) {
    ToolInput& tool = record.inputs.tools[i];
    const double phase = static_cast<double>(n) * 0.01 + static_cast<double>(i);
    tool.X_WD.p = Vec3(std::sin(phase), std::cos(phase), 1.0 / (1.0 + phase));
    tool.X_WD.q = Quat(Eigen::AngleAxisd(phase, Vec3::UnitX()));
    tool.grip_angle = 0.1 + 0.1 * std::sin(phase * 3.0);
    tool.grip_force = 0.2 * std::sqrt(phase);
    tool.has_grip_force = n % 3 == 0;
    tool.valid = n % 100 != 7;
    tool.buttons = static_cast<std::uint32_t>(n % 8);
  }
  return record;
}

inline SampleRecord sample(std::uint64_t n) {
  SampleRecord record;
  record.tool = static_cast<int>(n % 2);
  record.host_time_us = static_cast<std::int64_t>(n) * 1000;
  record.device_time_us = static_cast<std::int64_t>(n) * 1000 - 123;
  record.sequence = static_cast<std::uint32_t>(n);
  record.has_pose = n % 2 == 0;
  record.has_grip_angle = n % 3 != 0;
  record.has_grip_force = n % 5 != 0;
  if (record.has_pose) record.X_WD = step(n).inputs.tools[0].X_WD;
  if (record.has_grip_angle) record.grip_angle = std::sin(static_cast<double>(n));
  if (record.has_grip_force) record.grip_force = 0.001 * static_cast<double>(n);
  record.raw_angle = static_cast<std::int32_t>(n % 1024);
  record.raw_force = -static_cast<std::int32_t>(n % 512);
  record.buttons = static_cast<std::uint32_t>(n % 4);
  return record;
}

inline EventRecord event(std::uint64_t n) {
  EventRecord record;
  record.step = n;
  record.time = static_cast<double>(n) * 0.002;
  record.name = "grasp";
  record.tool = static_cast<int>(n % 2);
  record.value = 0.25 * static_cast<double>(n);
  record.unit = "N";
  if (n % 2 == 0) record.text = std::string_view("the jaws hold edge " + std::to_string(n));
  return record;
}

inline bool same(const Pose& a, const Pose& b) {
  return a.p == b.p && a.q.coeffs() == b.q.coeffs();
}

inline bool same(const StepRecord& a, const StepRecord& b) {
  bool equal = a.step == b.step && a.host_time_us == b.host_time_us && a.compute_us == b.compute_us &&
               a.state_hash == b.state_hash;
  for (std::size_t i = 0; i < 3; ++i) {
    const ToolInput& s = a.inputs.tools[i];
    const ToolInput& t = b.inputs.tools[i];
    equal = equal && same(s.X_WD, t.X_WD) && s.grip_angle == t.grip_angle && s.grip_force == t.grip_force &&
            s.has_grip_force == t.has_grip_force && s.valid == t.valid && s.buttons == t.buttons;
  }
  return equal;
}

inline bool same(const SampleRecord& a, const SampleRecord& b) {
  return a.tool == b.tool && a.host_time_us == b.host_time_us && a.device_time_us == b.device_time_us &&
         a.sequence == b.sequence && a.has_pose == b.has_pose && a.has_grip_angle == b.has_grip_angle &&
         a.has_grip_force == b.has_grip_force && same(a.X_WD, b.X_WD) && a.grip_angle == b.grip_angle &&
         a.grip_force == b.grip_force && a.raw_angle == b.raw_angle && a.raw_force == b.raw_force &&
         a.buttons == b.buttons;
}

inline bool same(const EventRecord& a, const EventRecord& b) {
  return a.step == b.step && a.time == b.time && a.name == b.name && a.tool == b.tool && a.value == b.value &&
         a.unit == b.unit && a.text == b.text;
}

inline RecordingMeta meta() {
  RecordingMeta meta;
  meta.program = "filum test";
  meta.task = "knot-square";
  meta.participant = "A17";
  meta.input = "synthetic";
  meta.dt = 0.002;
  meta.n_tools = 2;
  return meta;
}

inline RecorderOptions options(const std::string& file) {
  RecorderOptions options;
  options.file = file;
  options.meta = meta();
  options.sources = {{"models/suture/test.yaml", "diameter: 25 um\n"},
                     {"curricula/test.yaml", "task: knot-square\n"}};
  return options;
}

/// A whole finished recording of n steps, 2 n samples, an event every 10 steps and array hashes every 50.
inline void write_recording(const std::string& file, std::uint64_t n, bool scored = true) {
  RecorderOptions some = options(file);
  some.step_capacity = some.event_capacity = some.array_hash_capacity = n + 8;
  some.sample_capacity = 2 * n + 8;
  some.interval = std::chrono::hours(1);  // all of it at the end, so that blocks are full however slow the machine is
  Recorder recorder(some);
  for (std::uint64_t i = 1; i <= n; ++i) {
    recorder.record_step(step(i));
    recorder.record_sample(sample(2 * i));
    recorder.record_sample(sample(2 * i + 1));
    if (i % 10 == 0) recorder.record_event(event(i));
    if (i % 50 == 0) recorder.record_array_hash({i, "positions", i * 31});
  }
  if (scored) recorder.set_score({true, 87.5, 12.25, R"({"total": 87.5})"});
  EXPECT_TRUE(recorder.close()) << recorder.status().message;
}

/// A folder that goes away with the test.
class Folder {
 public:
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "filum test XXXXXX").string();
    EXPECT_NE(::mkdtemp(name.data()), nullptr);
    path_ = name;
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::permissions(path_, std::filesystem::perms::owner_all, ignored);
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::string file(const std::string& name) const { return (path_ / name).string(); }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// As an ordinary user while in scope: root may write anywhere. Skips nothing when the tests do not run as
/// root.
class OrdinaryUser {
 public:
  OrdinaryUser() : root_(::geteuid() == 0) {
    if (root_) changed_ = ::seteuid(65534) == 0;
  }
  ~OrdinaryUser() {
    if (changed_) {
      EXPECT_EQ(::seteuid(0), 0);
    }
  }
  bool is() const { return !root_ || changed_; }

 private:
  bool root_;
  bool changed_ = false;
};

}  // namespace filum::synthetic
