#include "cli/inputs.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "base/error.h"
#include "tests/session/synthetic.h"

namespace filum {
namespace inputs_test {

/// What the refusal of an input says; empty if it was taken.
std::string refusal(const std::string& input, const std::string& calibration = "", const std::string& task = "tip-hold", double motion_scale = 1.0) {
  try {
    open_inputs(input, FILUM_SOURCE_DIR, task, motion_scale, calibration);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

bool says(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

std::string recording(const synthetic::Folder& folder, int samples) {
  RecorderOptions o;
  o.file = folder.file("a.rec");
  o.meta.program = "test";
  o.meta.task = "tip-hold";
  o.meta.dt = 0.002;
  o.meta.n_tools = 2;
  Recorder recorder(o);
  for (int k = 1; k <= 20; ++k) EXPECT_TRUE(recorder.record_step(synthetic::step(static_cast<std::uint64_t>(k))));
  for (int k = 0; k < samples; ++k) recorder.record_sample(synthetic::sample(static_cast<std::uint64_t>(k)));
  EXPECT_TRUE(recorder.close()) << recorder.status().message;
  return o.file;
}

TEST(Inputs, ADemonstrationFollowsTheScenesClock) {
  std::string script = FILUM_SOURCE_DIR;  // appended: g++ 12 warns of overlap in a sum of strings
  script.append("/curricula/research/tip-hold/demonstration.yaml");
  const InputDevices demo = open_inputs("demo", FILUM_SOURCE_DIR, "tip-hold"), file = open_inputs(script, FILUM_SOURCE_DIR, "tip-hold");
  for (const InputDevices* d : {&demo, &file}) {
    EXPECT_TRUE(d->scripted);
    ASSERT_EQ(d->devices.size(), 1u);
    EXPECT_EQ(d->demonstrator, d->devices[0].get());
    EXPECT_EQ(d->pointer, nullptr);
  }
  EXPECT_EQ(demo.description, "demonstrator");
  EXPECT_EQ(file.description, "demonstration demonstration.yaml");
}

TEST(Inputs, ARecordingIsPlayedAgain) {
  const synthetic::Folder folder;
  const InputDevices d = open_inputs(recording(folder, 30), FILUM_SOURCE_DIR, "tip-hold");
  EXPECT_TRUE(d.scripted);
  EXPECT_EQ(d.demonstrator, nullptr);
  EXPECT_EQ(d.description, "replay a.rec");
  const synthetic::Folder empty;
  EXPECT_TRUE(says(refusal(recording(empty, 0)), "a recording with device samples"));
}

TEST(Inputs, HandsAreJoinedAndKnowTheirScale) {
  const InputDevices d = open_inputs("haptic:18930+igtl:18944", FILUM_SOURCE_DIR, "tip-hold", 0.25);
  EXPECT_FALSE(d.scripted);
  EXPECT_EQ(d.devices.size(), 2u);
  EXPECT_DOUBLE_EQ(d.scale.factor, 0.25);
  EXPECT_TRUE(says(d.description, " and ")) << d.description;
  EXPECT_TRUE(says(d.description, "motion scale 0.25")) << d.description;
  EXPECT_FALSE(says(open_inputs("haptic:18931", FILUM_SOURCE_DIR, "tip-hold").description, "scale"));
}

TEST(Inputs, RefusesWhatItCannotOpen) {
  for (const char* port : {"haptic:", "haptic:abc", "haptic:0", "haptic:65536", "haptic:80 ", "igtl:127.0.0.1:-1", "igtl:99999999999"}) EXPECT_TRUE(says(refusal(port), "a port, or ADDRESS:PORT")) << port;
  EXPECT_TRUE(says(refusal("haptic:18930+mouse"), "found mouse, expected serial:PATH, haptic:PORT or igtl:PORT"));
  EXPECT_TRUE(says(refusal("haptic:18930+"), "expected serial:PATH"));
  EXPECT_TRUE(says(refusal("nowhere.rec"), "nowhere.rec, expected demo, serial:PATH"));
  EXPECT_TRUE(says(refusal(FILUM_SOURCE_DIR), "expected demo, serial:PATH")) << "a folder";
  EXPECT_TRUE(says(refusal("demo", "", "no-such-task"), "a task with a demonstration"));
  EXPECT_TRUE(says(refusal("demo", "forceps.yaml"), "--input serial:PATH beside it")) << "a calibration needs a handle";
  EXPECT_TRUE(says(refusal("demo", "", "tip-hold", 0.5), "--motion-scale: input: found demo")) << "a scale needs hands";
  EXPECT_TRUE(says(refusal("serial:/none", "/none.yaml"), "/none.yaml")) << "the calibration is read first";
}

TEST(Inputs, LiveWithoutDevicesIsThePointer) {
  const InputDevices d = open_live_inputs({}, FILUM_SOURCE_DIR);
  ASSERT_EQ(d.devices.size(), 1u);
  EXPECT_EQ(d.pointer, d.devices[0].get());
  EXPECT_EQ(d.description, "pointer");
  EXPECT_FALSE(d.scripted);
  EXPECT_FALSE(LiveDevices{}.any());
  LiveDevices hands;
  hands.hands = "haptic:18932";
  EXPECT_TRUE(hands.any());
  EXPECT_EQ(open_live_inputs(hands, FILUM_SOURCE_DIR).pointer, nullptr);
}

TEST(Inputs, ARefusalNamesTheOptionThatWasGiven) {
  LiveDevices live;
  for (const char* hands : {"mouse", "haptic:none"}) {
    EXPECT_EQ(refusal(std::string("igtl:18945+") + hands).find("--input: "), 0u);
    live.hands = hands;
    try {
      open_live_inputs(live, FILUM_SOURCE_DIR);
      ADD_FAILURE() << hands << " was taken";
    } catch (const InputError& error) {
      EXPECT_EQ(error.file, "--hands");
    }
  }
}

TEST(Inputs, EveryStateOfADeviceHasAName) {
  for (const auto& [state, name] : {std::pair{DeviceState::waiting, "waiting"}, {DeviceState::live, "live"}, {DeviceState::stale, "stale"}, {DeviceState::lost, "lost"}, {DeviceState::finished, "finished"}})
    EXPECT_STREQ(name_of(state), name);
}

}  // namespace inputs_test
}  // namespace filum
