#include "cli/trainer_check.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "devices/haptic_link.h"
#include "tests/refusal.h"
#include "tests/devices/pty.h"
#include "tests/session/synthetic.h"

namespace filum {
namespace trainer_check_test {

namespace fs = std::filesystem;

const std::string kRoot = FILUM_SOURCE_DIR;

class TrainerCheck : public testing::Test {
 protected:
  TrainerCheck() { options_.root = kRoot; }

  std::string file(const std::string& name, const std::string& text = "") const {
    std::ofstream(folder_.file(name)) << text;
    return folder_.file(name);
  }
  InputError refusal() const { return refusal_by([&] { check_trainer_options(options_); }); }
  void expect_refused(const std::string& option, const std::string& field, const std::string& value, const std::string& expected) const {
    const InputError error = refusal();
    EXPECT_EQ(error.file, option) << error.what();
    EXPECT_EQ(error.field, field) << error.what();
    EXPECT_EQ(error.value, value) << error.what();
    EXPECT_NE(error.expected.find(expected), std::string::npos) << error.what();
  }

  synthetic::Folder folder_;
  TrainerOptions options_;
};

TEST_F(TrainerCheck, WhatIsShippedIsTakenWithoutAPage) { EXPECT_NO_THROW(check_trainer_options(options_)); }

TEST_F(TrainerCheck, ARootWithoutTasksIsNamed) {
  options_.root = folder_.file("nowhere");
  expect_refused("--root", "curricula", options_.root, "a folder with models/ and curricula/");
}

TEST_F(TrainerCheck, WhereNoTaskCanBeReadTheFirstReasonIsTold) {
  options_.root = folder_.file("");
  fs::create_directories(folder_.file("curricula/broken"));
  file("curricula/broken/scene.yaml", "format: filum-scene/1\n");
  file("curricula/broken/task.yaml", "format: filum-task/9\n");
  const InputError error = refusal();
  EXPECT_EQ(error.file, "--root");
  EXPECT_NE(error.value.find("no task that can be read"), std::string::npos) << error.what();
  EXPECT_NE(error.value.find("filum-task/9"), std::string::npos) << error.what();
}

TEST_F(TrainerCheck, AModelThatOneTaskCanTakeIsTaken) {
  for (const char* model : {"suture/8-0-nylon", "vessel/rat-femoral-artery", "brain/sylvian"}) {
    options_.model_file = kRoot + "/models/" + model + ".yaml";
    EXPECT_EQ(refusal().value, "taken") << model << ": " << refusal().what();
  }
}

TEST_F(TrainerCheck, AModelThatNoTaskCanTakeIsNamedWithTheLastReason) {
  options_.model_file = kRoot + "/models/instrument/forceps.yaml";
  expect_refused("--model", "model", options_.model_file, "found \"filum-instrument/1\", expected filum-");
  options_.model_file = folder_.file("none.yaml");
  expect_refused("--model", "model", options_.model_file, "a model that a task can take (the last one said: " + options_.model_file);
}

TEST_F(TrainerCheck, AViewerIsAFolderWithAPage) {
  options_.viewer_folder = folder_.file("");
  expect_refused("--viewer", "index.html", "none in " + options_.viewer_folder, "the folder of the built viewer");
  fs::create_directory(folder_.file("index.html"));
  expect_refused("--viewer", "index.html", "none in " + options_.viewer_folder, "the folder of the built viewer");
  fs::remove(folder_.file("index.html"));
  file("index.html", "<!doctype html>");
  EXPECT_NO_THROW(check_trainer_options(options_));
}

TEST_F(TrainerCheck, ACameraIsANumberAVideoOrNumberedPicturesInAFolder) {
  for (const std::string& source : {std::string(), std::string("0"), std::string("17"), file("video.avi"), std::string("view_%03d.png"), folder_.file("view_%03d.png")}) {
    options_.camera = source;
    EXPECT_EQ(refusal().value, "taken") << source;
  }
  for (const std::string& source : {std::string("-1"), std::string("1a"), folder_.file("none.avi"), folder_.file(""),
                                    folder_.file("none/view_%03d.png"), file("text") + "/view_%03d.png"}) {
    options_.camera = source;
    expect_refused("--camera", "source", source, "a video that is there");
  }
}

TEST_F(TrainerCheck, ACalibrationIsReadOfAForcepsThatIsThereOnly) {
  options_.calibration = kRoot + "/models/forceps/default.yaml";
  expect_refused("--forceps", "calibration", options_.calibration, "--serial PATH beside it");
  const Pty pty;
  options_.serial_port = pty.path();
  EXPECT_NO_THROW(check_trainer_options(options_));
  options_.calibration = file("forceps.yaml", "format: filum-forceps/9\n");
  const InputError error = refusal();
  EXPECT_NE(error.file.find(options_.calibration), std::string::npos) << error.what();
  EXPECT_EQ(error.value, "\"filum-forceps/9\"");
}

TEST_F(TrainerCheck, ASerialPortThatIsNotThereIsNamed) {
  options_.serial_port = folder_.file("none");
  const InputError error = refusal();
  EXPECT_NE(std::string(error.what()).find(options_.serial_port), std::string::npos) << error.what();
  EXPECT_NE(error.expected.find("serial port"), std::string::npos) << error.what();
}

/// The sessions open the devices anew: a check that kept one would shut them out.
TEST_F(TrainerCheck, DevicesAreLetGoAgain) {
  int port = 0;
  {
    const HapticLink other("127.0.0.1", 0);
    port = other.port();
    options_.hands = "haptic:" + std::to_string(port);
    EXPECT_NE(std::string(refusal().what()).find(std::to_string(port)), std::string::npos) << "in use: " << refusal().what();
  }
  for (int k = 0; k < 2; ++k) EXPECT_NO_THROW(check_trainer_options(options_));
  EXPECT_EQ(HapticLink("127.0.0.1", port).port(), port);
}

TEST_F(TrainerCheck, HandsThatAreNoneAreNamed) {
  for (const char* hands : {"mouse:1", "haptic", "igtl:18944+mouse"}) {
    options_.hands = hands;
    EXPECT_EQ(refusal().file, "--hands") << hands;
    EXPECT_EQ(refusal().field, "device") << hands;
  }
  for (const char* hands : {"haptic:0", "haptic:65536", "haptic:", "igtl:x"}) {
    options_.hands = hands;
    EXPECT_EQ(refusal().file, "--hands") << hands;
    EXPECT_EQ(refusal().field, "port") << hands;
  }
}

}  // namespace trainer_check_test
}  // namespace filum
