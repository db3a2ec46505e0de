#include "cli/trainer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "base/error.h"
#include "altered_recording.h"
#include "started_trainer.h"
#include "tests/devices/pty.h"
#include "tests/session/disk_limit.h"

namespace filum {
namespace trainer_test {

using nlohmann::json;

TEST(Trainer, ATaskIsShownRecordedScoredAndReplayed) {
  const StartedTrainer trainer;
  Client browser(trainer.port());
  const json hello = browser.hear("hello");
  EXPECT_EQ(hello.at("inputs"), json({"pointer", "demo"}));
  const auto& tasks = hello.at("tasks");
  EXPECT_TRUE(std::any_of(tasks.begin(), tasks.end(), [](const json& t) { return t.at("name") == "tip-hold"; }));
  browser.say(R"({"type":"start","task":"tip-hold","input":"demo","code":"P01"})");
  EXPECT_EQ(browser.hear("scene").at("task"), "tip-hold");
  const json running = hear_state(browser, "running");
  EXPECT_TRUE(running.at("recording").get<bool>());
  const std::string id = running.at("session");
  EXPECT_FALSE(id.empty());
  run_until(browser, 0.2);
  browser.say(R"({"type":"stop"})");
  EXPECT_EQ(browser.hear("result").at("session"), id);
  hear_state(browser, "ended");
  const json sessions = trainer.get("/api/sessions").at("sessions");
  ASSERT_EQ(sessions.size(), 1u);
  EXPECT_EQ(sessions[0].at("id"), id);
  EXPECT_EQ(sessions[0].at("code"), "P01");
  EXPECT_TRUE(sessions[0].at("finished").get<bool>());
  browser.say(R"({"type":"replay_open","session":")" + id + "\"}");
  hear_state(browser, "replay");
  EXPECT_GT(browser.hear("replay_state").at("duration").get<double>(), 0.2);
  browser.say(R"({"type":"stop"})");
  hear_state(browser, "idle");
}

TEST(Trainer, WhatCannotBeDoneIsSaidAndTheTrainerGoesOn) {
  const StartedTrainer trainer;
  Client browser(trainer.port());
  const auto refused = [&](const std::string& message) {
    browser.say(message);
    const json error = browser.hear("error");
    EXPECT_EQ(error.at("code"), "bad-input") << error;
    return error.at("what").get<std::string>() + " " + error.at("advice").get<std::string>();
  };
  EXPECT_NE(refused(R"({"type":"start","task":"no-such-task","input":"demo"})").find("no-such-task"), std::string::npos);
  EXPECT_NE(refused(R"({"type":"start","task":"tip-hold","input":"device"})").find("--serial"), std::string::npos);
  EXPECT_NE(refused(R"({"type":"replay_open","session":"none"})").find("stored session"), std::string::npos);
  browser.say(R"({"type":"start","task":"tip-hold","input":"pointer","exam":true})");
  hear_state(browser, "running");
  EXPECT_NE(refused(R"({"type":"overlay","kind":"strain"})").find("while an exam runs"), std::string::npos);
  EXPECT_EQ(trainer.get("/api/health").at("state"), "running");
}

/// Sends poses of the first tool until the trainer's device of this number has received one, or for 200 frames. What is then said of the device.
json moved_by_pointer(Client& browser, std::size_t number) {
  json device;
  for (int k = 0; k < 200 && (device.is_null() || device.at("received") == 0); ++k) {
    browser.say(R"({"type":"pointer","tool":0,"time":)" + std::to_string(0.01 * k) + R"(,"position":[0,0,0.01],"quaternion":[1,0,0,0],"grip":0.2,"buttons":0})");
    const json frame = browser.hear("frame");
    device = frame.at("devices").at(number);
    browser.say(R"({"type":"ack","frame":)" + frame.at("id").dump() + "}");
  }
  return device;
}

TEST(Trainer, ThePointerMovesTheToolOnlyWhileItsBrowserIsThere) {
  const StartedTrainer trainer;
  Client browser(trainer.port());
  browser.say(R"({"type":"start","task":"tip-hold","input":"pointer"})");
  hear_state(browser, "running");
  const json device = moved_by_pointer(browser, 0);
  EXPECT_GT(device.at("received").get<int>(), 0) << device;
  browser.vanish();
  Client watcher(trainer.port());
  for (;;) {
    const json frame = watcher.hear("frame");
    watcher.say(R"({"type":"ack","frame":)" + frame.at("id").dump() + "}");
    if (frame.at("devices").at(0).at("state") == "lost") break;  // else the test ends by its time
  }
}

/// A handle that does not know where it is: the pointer moves the instrument, and the page is told so.
TEST(Trainer, BesideForcepsThePointerMovesTheTool) {
  const synthetic::Folder folder;
  const Pty pty(folder.file("port"));
  TrainerOptions options;
  options.serial_port = pty.path();
  const StartedTrainer trainer(options);
  Client browser(trainer.port());
  browser.say(R"({"type":"start","task":"tip-hold","input":"demo"})");
  EXPECT_FALSE(hear_state(browser, "running").at("pointer").get<bool>());
  browser.say(R"({"type":"start","task":"tip-hold","input":"device"})");
  EXPECT_TRUE(hear_state(browser, "running").at("pointer").get<bool>());
  const json device = moved_by_pointer(browser, 1);
  EXPECT_GT(device.at("received").get<int>(), 0) << device;
  browser.say(R"({"type":"stop"})");
  EXPECT_FALSE(hear_state(browser, "ended").at("pointer").get<bool>());
}

TEST(Trainer, AStartThatIsRefusedLeavesTheForcepsFreeForACalibration) {
  const synthetic::Folder folder;
  Pty pty(folder.file("port"));
  TrainerOptions options;
  options.serial_port = pty.path();
  StartedTrainer trainer(options);
  Client browser(trainer.port());
  pty.unplug();
  browser.say(R"({"type":"start","task":"tip-hold","input":"device"})");
  browser.hear("error");
  hear_state(browser, "idle");
  pty.plug();
  const json answer = json::parse(trainer->post("/api/calibration/start", "{}").value());
  EXPECT_FALSE(answer.contains("refused")) << answer;
}

TEST(Trainer, WithoutAStoreItTrainsAndWarns) {
  const synthetic::Folder folder;
  std::ofstream(folder.file("file")) << "in the way";
  TrainerOptions options;
  options.store_folder = folder.file("file");
  StartedTrainer trainer(options);
  EXPECT_NE(trainer->store_warning().find("NOT being stored"), std::string::npos);
  Client browser(trainer.port());
  browser.say(R"({"type":"start","task":"tip-hold","input":"demo"})");
  const json running = hear_state(browser, "running");
  EXPECT_FALSE(running.at("recording").get<bool>());
  EXPECT_NE(running.at("warning").get<std::string>().find("NOT being stored"), std::string::npos);
  EXPECT_TRUE(trainer.get("/api/sessions").at("sessions").empty());
}

TEST(Trainer, RatingsThatCannotBeOpenedAreWarnedOfAndSessionsAreStored) {
  const synthetic::Folder folder;
  std::filesystem::create_directory(folder.file("store"));
  std::ofstream(folder.file("store/ratings.sqlite")) << "rubbish";
  TrainerOptions options;
  options.store_folder = folder.file("store");
  StartedTrainer trainer(options);
  EXPECT_NE(trainer->store_warning().find("Ratings are NOT being stored"), std::string::npos) << trainer->store_warning();
  Client browser(trainer.port());
  browser.say(R"({"type":"start","task":"tip-hold","input":"demo"})");
  const json running = hear_state(browser, "running");
  EXPECT_TRUE(running.at("recording").get<bool>());
  EXPECT_NE(running.at("warning").get<std::string>().find("ratings.sqlite"), std::string::npos);
}

TEST(Trainer, ADamagedRecordingIsShownAndWarnedOf) {
  const StartedTrainer trainer;
  Client browser(trainer.port());
  browser.say(R"({"type":"start","task":"tip-hold","input":"demo"})");
  const std::string id = hear_state(browser, "running").at("session");
  run_until(browser, 0.1);
  browser.say(R"({"type":"stop"})");
  hear_state(browser, "ended");
  const std::string file = trainer.folder().file("store/" + id + kRecordingSuffix), sound = trainer.folder().file("sound");
  std::filesystem::rename(file, sound);
  damage(sound, "title: 8-0 polypropylene", file);
  browser.say(R"({"type":"replay_open","session":")" + id + "\"}");
  const std::string warning = hear_state(browser, "replay").at("warning");
  EXPECT_EQ(warning.find("This recording is damaged: source models/suture/"), 0u) << warning;
  browser.say(R"({"type":"stop"})");
  EXPECT_EQ(hear_state(browser, "idle").at("warning"), "");
}

TEST(Trainer, OnAFullDiskBothTheRecordingAndTheIndexAreWarnedOf) {
  const StartedTrainer trainer;
  Client browser(trainer.port());
  browser.say(R"({"type":"start","task":"tip-hold","input":"demo"})");
  ASSERT_TRUE(hear_state(browser, "running").at("recording").get<bool>());
  const DiskLimit full(0);
  browser.say(R"({"type":"stop"})");
  const std::string warning = hear_state(browser, "ended").at("warning");
  EXPECT_NE(warning.find("incomplete"), std::string::npos) << warning;
  EXPECT_NE(warning.find("not entered in the index"), std::string::npos) << warning;
  EXPECT_EQ(warning.find("is stored"), std::string::npos) << warning;
}

TEST(Trainer, AModelThatNoTaskCanTakeIsRefusedAtOnce) {
  const synthetic::Folder folder;
  std::ofstream(folder.file("model.yaml")) << "format: filum-suture/1\ntitle: no numbers\n";
  TrainerOptions options;
  options.model_file = folder.file("model.yaml");
  EXPECT_THROW(StartedTrainer{options}, InputError);
}

TEST(Trainer, GripOpensToTheWidestAndSqueezesBeyondClosure) {
  EXPECT_DOUBLE_EQ(grip_angle_of(0.0, 0.4), 0.4);
  EXPECT_DOUBLE_EQ(grip_angle_of(0.5 * kClosedGrip, 0.4), 0.2);
  EXPECT_NEAR(grip_angle_of(kClosedGrip, 0.4), 0.0, 1e-15);
  EXPECT_DOUBLE_EQ(grip_angle_of(1.0, 0.4), -0.25);
}

}  // namespace trainer_test
}  // namespace filum
