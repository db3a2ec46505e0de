// Motion-BIDS from a recording: the files, their columns and what is absent. The check by bids-validator itself is run where
// FILUM_BIDS_VALIDATOR names the program (npm package bids-validator; 700 MB with what it needs).
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "base/error.h"
#include "session/export.h"
#include "tests/session/disk_limit.h"
#include "tests/session/synthetic.h"

namespace filum {
namespace export_bids_test {

namespace fs = std::filesystem;

using Change = std::function<void(std::uint64_t, SampleRecord&)>;

void record(const std::string& file, const std::string& participant, const std::string& started, const Change& change = [](std::uint64_t, SampleRecord&) {}) {
  RecorderOptions o;
  o.file = file;
  o.meta.program = "filum test";
  o.meta.task = "tip-hold";
  o.meta.participant = participant;
  o.meta.started_utc = started;
  o.meta.input = "serial /dev/ttyACM0";
  o.meta.dt = 0.002;
  o.meta.n_tools = 1;
  Recorder recorder(o);
  for (std::uint64_t i = 1; i <= 200; ++i) {
    recorder.record_step(synthetic::step(i));
    for (std::uint64_t k = 2 * i; k < 2 * i + 2; ++k) {
      SampleRecord sample = synthetic::sample(k);
      sample.tool = 0;
      change(k, sample);
      recorder.record_sample(sample);
    }
    if (i % 50 == 0) recorder.record_event(synthetic::event(i));
  }
  ASSERT_TRUE(recorder.close()) << recorder.status().message;
}

std::vector<std::string> lines_of(const fs::path& path) {
  std::ifstream stream(path);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

std::size_t cells(const std::string& line) { return 1 + static_cast<std::size_t>(std::count(line.begin(), line.end(), '\t')); }

TEST(ExportBids, WritesOneTrackingSystemForHandAndScene) {
  synthetic::Folder folder;
  record(folder.file("a.rec"), "P01", "2026-11-21T09:30:00Z");
  const auto files = export_bids(RecordingReader(folder.file("a.rec")), folder.file("set"));
  EXPECT_GE(files.size(), 13u);
  const fs::path motion = folder.path() / "set/sub-P01/ses-20261121T093000Z/motion";
  const std::string prefix = "sub-P01_ses-20261121T093000Z_task-tiphold";
  for (const std::string& file : files) EXPECT_TRUE(fs::is_regular_file(file)) << file;
  for (const std::string system : {"hand0", "scene0"}) {
    const auto rows = lines_of(motion / (prefix + "_tracksys-" + system + "_motion.tsv"));
    const auto channels = lines_of(motion / (prefix + "_tracksys-" + system + "_channels.tsv"));
    ASSERT_EQ(rows.size(), system == "hand0" ? 400u : 200u);
    EXPECT_EQ(channels.front(), "name\tcomponent\ttype\ttracked_point\tunits");
    for (const std::string& row : rows) ASSERT_EQ(cells(row), channels.size() - 1) << "a column for each channel, no header";
    std::ifstream side(motion / (prefix + "_tracksys-" + system + "_motion.json"));
    const auto json = nlohmann::json::parse(side);
    EXPECT_EQ(json["TaskName"], "tip-hold");
    EXPECT_EQ(json["MotionChannelCount"], channels.size() - 1);
    EXPECT_NEAR(json["SamplingFrequency"].get<double>(), system == "hand0" ? 1000.0 : 500.0, 1e-6);
  }
  const auto hand = lines_of(motion / (prefix + "_tracksys-hand0_motion.tsv"));
  EXPECT_NE(hand[1].find("n/a"), std::string::npos) << "what was not measured is n/a, not zero";
  EXPECT_EQ(lines_of(motion / (prefix + "_events.tsv")).size(), 5u);
  EXPECT_EQ(lines_of(folder.path() / "set/sub-P01/ses-20261121T093000Z/sub-P01_ses-20261121T093000Z_scans.tsv").size(), 3u);
}

TEST(ExportBids, RecordingsJoinOneDatasetAndTwiceIsOnce) {
  synthetic::Folder folder;
  record(folder.file("a.rec"), "P01", "2026-11-21T09:30:00Z");
  record(folder.file("b.rec"), "P02", "2026-11-21T10:30:00Z");
  for (const char* name : {"a.rec", "b.rec", "a.rec"}) export_bids(RecordingReader(folder.file(name)), folder.file("set"));
  EXPECT_EQ(lines_of(folder.path() / "set/participants.tsv").size(), 3u);
}

/// First column of the readings of tool 0. [s]
std::vector<double> latencies(const fs::path& set) {
  std::vector<double> times;
  for (const auto& entry : fs::recursive_directory_iterator(set)) {
    if (entry.path().string().ends_with("_tracksys-hand0_motion.tsv"))
      for (const std::string& line : lines_of(entry.path())) times.push_back(std::stod(line));
  }
  return times;
}

TEST(ExportBids, ReadingsOfSeveralDevicesHaveOneClock) {
  synthetic::Folder folder;
  record(folder.file("a.rec"), "P01", "2026-11-21T09:30:00Z", [](std::uint64_t k, SampleRecord& s) {
    s.device_time_us = k % 2 == 0 ? 1'795'000'000'000'000 + s.host_time_us  // a camera's, since 1970
                                  : k < 200 ? 900'000'000 + s.host_time_us : s.host_time_us - 200'000;  // a handle's, which starts again
  });
  export_bids(RecordingReader(folder.file("a.rec")), folder.file("set"));
  const auto times = latencies(folder.path() / "set");
  ASSERT_EQ(times.size(), 400u);
  for (std::size_t k = 0; k < times.size(); ++k) ASSERT_NEAR(times[k], 1e-3 * static_cast<double>(k), 1e-9);
  std::string text;
  for (const std::string& line : lines_of(folder.path() / "set/README")) text += line + " ";
  EXPECT_NE(text.find("clock of the computer that recorded"), std::string::npos) << text;
}

TEST(ExportBids, CodesThatDifferInSignsOnlyArePeopleOfTheirOwn) {
  synthetic::Folder folder;
  const std::vector<std::string> codes{"P1", "P_1", "P-1", "P1_", "--", "__", "", "unknown"};
  for (std::size_t k = 0; k < codes.size(); ++k) {
    record(folder.file(std::to_string(k)), codes[k], "2026-11-21T09:30:00Z", [&](std::uint64_t, SampleRecord& s) { s.raw_angle = static_cast<std::int32_t>(k); });
    export_bids(RecordingReader(folder.file(std::to_string(k))), folder.file("set"));
  }
  std::set<std::string> people;
  for (const auto& entry : fs::directory_iterator(folder.path() / "set")) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("sub-")) people.insert(name);
  }
  EXPECT_EQ(people.size(), codes.size());
  for (const std::string& name : people) EXPECT_TRUE(std::all_of(name.begin() + 4, name.end(), [](unsigned char c) { return std::isalnum(c); })) << name;
  EXPECT_TRUE(people.contains("sub-P1") && people.contains("sub-unknown"));
  EXPECT_EQ(lines_of(folder.path() / "set/participants.tsv").size(), codes.size() + 1);
}

std::map<std::string, std::string> contents(const fs::path& folder) {
  std::map<std::string, std::string> all;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    std::ifstream file(entry.path());
    all[entry.path().string()] = entry.is_regular_file() ? std::string(std::istreambuf_iterator<char>(file), {}) : "";
  }
  return all;
}

TEST(ExportBids, AnotherRecordingOfTheSameSecondIsRefusedAndNothingChanges) {
  synthetic::Folder folder;
  record(folder.file("a.rec"), "P01", "2026-11-21T09:30:00Z");
  record(folder.file("b.rec"), "P01", "2026-11-21T09:30:00Z", [](std::uint64_t, SampleRecord& s) { s.raw_force = 7; });
  record(folder.file("c.rec"), "P01", "2026-11-21T09:30:00Z", [](std::uint64_t k, SampleRecord& s) { s.tool = k > 300 ? 1 : 0; });
  export_bids(RecordingReader(folder.file("a.rec")), folder.file("set"));
  const auto before = contents(folder.path() / "set");
  for (const char* other : {"b.rec", "c.rec"}) {
    try {
      export_bids(RecordingReader(folder.file(other)), folder.file("set"));
      ADD_FAILURE() << other << " was written over the first";
    } catch (const InputError& error) {
      EXPECT_NE(error.file.find("_motion.tsv"), std::string::npos) << error.what();
      EXPECT_EQ(error.value, "a file of another recording or program");
    }
    EXPECT_EQ(contents(folder.path() / "set"), before) << other;
  }
}

TEST(ExportBids, OnAFullDiskTheDatasetStaysAsItWas) {
  synthetic::Folder folder;
  record(folder.file("a.rec"), "P01", "2026-11-21T09:30:00Z");
  record(folder.file("b.rec"), "P02", "2026-11-21T10:30:00Z");
  export_bids(RecordingReader(folder.file("a.rec")), folder.file("set"));
  const RecordingReader second(folder.file("b.rec"));
  const auto before = contents(folder.path() / "set");
  {
    const DiskLimit limit(8192);  // enough for all but the motion
    try {
      export_bids(second, folder.file("set"));
      ADD_FAILURE() << "written";
    } catch (const InputError& error) {
      ADD_FAILURE() << "no bad input: " << error.what();
    } catch (const std::exception& error) {
      EXPECT_NE(std::string(error.what()).find("_motion.tsv: export: found a write error"), std::string::npos) << error.what();
    }
  }
  EXPECT_EQ(contents(folder.path() / "set"), before);
}

TEST(ExportBids, TheValidatorFindsNoErrors) {
  const char* validator = std::getenv("FILUM_BIDS_VALIDATOR");
  if (!validator) GTEST_SKIP() << "set FILUM_BIDS_VALIDATOR to the program of the npm package bids-validator to run this";
  synthetic::Folder folder;
  record(folder.file("a.rec"), "P01", "2026-11-21T09:30:00Z");
  export_bids(RecordingReader(folder.file("a.rec")), folder.file("set"));
  const std::string report = folder.file("report.json");
  const std::string command = std::string("'") + validator + "' --json '" + folder.file("set") + "' > '" + report + "' 2>/dev/null";
  (void)std::system(command.c_str());
  std::ifstream stream(report);
  const auto json = nlohmann::json::parse(stream);
  EXPECT_TRUE(json["issues"]["errors"].empty()) << json["issues"]["errors"].dump(1);
}

}  // namespace export_bids_test
}  // namespace filum
