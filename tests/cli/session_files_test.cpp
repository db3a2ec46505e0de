#include "cli/session_files.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "short_session.h"
#include "training/result_json.h"
#include "world/model.h"

namespace filum {
namespace session_files_test {

namespace fs = std::filesystem;

class SessionFiles : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "filum-files-XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  void TearDown() override { fs::remove_all(folder_); }
  fs::path folder_;
};

TEST_F(SessionFiles, ARecordingHoldsAllItWasMadeFromAndScoresTheSame) {
  const std::string file = (folder_ / "one.filum-session").string();
  LiveOutcome live;
  {
    const auto recorder = make_recorder(file, load_setup(FILUM_SOURCE_DIR, "tip-hold"), "demonstrator", "P01");
    live = started_session(recorder.get())->wait();
  }
  const RecordingReader recording(file);
  EXPECT_EQ(recording.meta().task, "tip-hold");
  EXPECT_EQ(recording.meta().participant, "P01");
  fs::path sources;
  {
    const RecordedSetup recorded(recording);
    sources = recorded.setup().root;
    EXPECT_NE(sources, fs::path(FILUM_SOURCE_DIR));
    EXPECT_EQ(recorded.setup().model->description.n_tools, load_setup(FILUM_SOURCE_DIR, "tip-hold").model->description.n_tools);
  }
  EXPECT_FALSE(fs::exists(sources)) << "the copies go with the object";
  const Rescored again = rescore(recording);
  EXPECT_TRUE(again.replay.identical);
  EXPECT_EQ(again.replay.steps, live.steps);
  EXPECT_EQ(result_json(again.result), result_json(live.result));
}

TEST_F(SessionFiles, WhatATaskDoesNotMeasureIsNotTold) {
  const LiveOutcome live = started_session(nullptr)->wait();
  const auto document = result_document(live.result);
  EXPECT_TRUE(document.at("knot").is_null());
  EXPECT_FALSE(document.contains("series"));
  EXPECT_FALSE(document.contains("paths"));
  const auto message = nlohmann::json::parse(result_message(live.result, ""));
  EXPECT_EQ(message.at("type"), "result");
  EXPECT_TRUE(message.at("session").is_null());
  EXPECT_TRUE(message.at("knot").is_null());
}

/// A part that was left out here was measured and never seen.
TEST_F(SessionFiles, EveryPartOfAResultReachesTheBrowser) {
  std::ifstream file(std::string(FILUM_SOURCE_DIR) + "/src/server/messages.schema.json");
  const auto schema = nlohmann::json::parse(file);
  nlohmann::json whole = nlohmann::json::object();
  for (const auto& [key, _] : schema.at("$defs").at("Result").at("properties").items())
    if (key != "type" && key != "session") whole[key] = key + " of this result";
  const auto message = nlohmann::json::parse(result_message(whole.dump(), "s"));
  EXPECT_TRUE(message.contains("handling"));
  for (const auto& [key, value] : whole.items()) EXPECT_EQ(message.value(key, nlohmann::json()), value) << key;
}

TEST_F(SessionFiles, AStoredResultWithOneScaleHasAListOfIt) {
  auto stored = nlohmann::json::object();
  for (const char* key : {"task", "title", "finished", "passed", "seconds", "score", "knot", "events", "series", "paths"}) stored[key] = key;
  EXPECT_FALSE(nlohmann::json::parse(result_message(stored.dump(), "s")).contains("scales"));
  stored["scale"] = {{"name", "mars10"}};
  const auto message = nlohmann::json::parse(result_message(stored.dump(), "s"));
  EXPECT_EQ(message.at("scales"), nlohmann::json::array({stored["scale"]}));
  EXPECT_FALSE(message.contains("scale"));
}

TEST_F(SessionFiles, AnEarlierProgramsFlowOnThroughTheJoinIsShown) {
  auto stored = nlohmann::json::object();
  for (const char* key : {"task", "title", "finished", "passed", "seconds", "score", "knot", "events", "series", "paths"}) stored[key] = key;
  stored["leak"] = {{"total_ml_per_min", 0.4}, {"flow_if_tight_ml_per_min", 9.0}};
  const auto message = nlohmann::json::parse(result_message(stored.dump(), "s"));
  EXPECT_EQ(message.at("leak"), nlohmann::json({{"total_ml_per_min", 0.4}, {"through_ml_per_min", 9.0}}));
}

TEST_F(SessionFiles, StoredTextThatIsNoResultGivesNoMessage) {
  for (const char* text : {"", "{", "[]", "null", "{\"task\": 1}"}) EXPECT_EQ(result_message(std::string(text), "s"), "") << text;
}

TEST_F(SessionFiles, ARecordingTellsUnderWhichConditionsItWasMade) {
  const std::string plain = (folder_ / "plain.filum-session").string(), exam = (folder_ / "exam.filum-session").string();
  make_recorder(plain, load_setup(FILUM_SOURCE_DIR, "tip-hold"), "demonstrator")->close();
  {
    const auto recorder = make_recorder(exam, load_setup(FILUM_SOURCE_DIR, "press-to-target", "", 2.5), "pointer");
    recorder->record_event({0, 0.0, "exam", -1, 1.0, "-"});
    recorder->close();
  }
  const Conditions a = read_conditions(RecordingReader(plain)), b = read_conditions(RecordingReader(exam));
  EXPECT_EQ(a.input, "demo");
  EXPECT_FALSE(a.exam);
  EXPECT_EQ(a.stiffness, 1.0);
  EXPECT_EQ(b.input, "pointer");
  EXPECT_TRUE(b.exam);
  EXPECT_EQ(b.stiffness, 2.5);
}

}  // namespace session_files_test
}  // namespace filum
