// filum replay: equal recordings are told from altered ones, to the step.

#include <gtest/gtest.h>

#include <fstream>

#include "altered_recording.h"
#include "program_call.h"
#include "tests/session/synthetic.h"

namespace filum {
namespace replay_test {

TEST(Replay, ARecordingStepsToTheSameStates) {
  const synthetic::Folder folder;
  const auto run = nlohmann::ordered_json::parse(recorded_run(folder.file("one")));
  const auto d = call({"replay", folder.file("one"), "--json"}).json();
  EXPECT_TRUE(d["identical"].get<bool>());
  EXPECT_TRUE(d["first_difference"].is_null());
  EXPECT_EQ(d["steps"], run["steps"]);
  EXPECT_EQ(d["recorded_by"], program_text());
  EXPECT_TRUE(d["finished"].get<bool>());
  EXPECT_EQ(call({"replay", folder.file("one")}).out, "identical: " + run["steps"].dump() + " steps\n");
}

TEST(Replay, TheFirstStepThatDiffersIsNamedAndTheExitCodeSaysSo) {
  const synthetic::Folder folder;
  recorded_run(folder.file("one"));
  write_altered(folder.file("one"), folder.file("altered"));
  const Call c = call({"replay", folder.file("altered"), "--json"});
  EXPECT_EQ(c.code, kFailed);
  const auto d = nlohmann::ordered_json::parse(c.out);
  EXPECT_FALSE(d["identical"].get<bool>());
  EXPECT_EQ(d["first_difference"]["step"], kAlteredStep);
  EXPECT_EQ(d["first_difference"]["array"], "state");
  EXPECT_NE(call({"replay", folder.file("altered")}).out.find("first difference at step 100 "), std::string::npos);
}

TEST(Replay, WithoutAStepThereIsNothingToReplay) {
  const synthetic::Folder folder;
  make_recorder(folder.file("none"), load_setup(FILUM_SOURCE_DIR, "tip-hold"), "pointer")->close();
  expect_refused({"replay", folder.file("none"), "--json"}, {folder.file("none"), "steps: found none", "nothing to replay"});
  expect_refused({"score", folder.file("none"), "--json"}, {folder.file("none"), "steps: found none", "nothing to replay"});
}

TEST(Replay, DamageBesideTheStepsIsNamedAndTheStepsAreCompared) {
  const synthetic::Folder folder;
  recorded_run(folder.file("one"));
  write_altered(folder.file("one"), folder.file("sound"), 0);
  damage(folder.file("sound"), "planted-event", folder.file("events"));
  for (const char* command : {"replay", "score"}) {
    const Call c = call({command, folder.file("events"), "--json"});
    EXPECT_EQ(c.code, kBadInput) << command;
    EXPECT_NE(c.err.find("events block 1 with a wrong checksum"), std::string::npos) << c.err;
    const auto d = nlohmann::ordered_json::parse(c.out);
    EXPECT_TRUE(d[command == std::string("replay") ? "identical" : "replay_identical"].get<bool>()) << command;
    EXPECT_EQ(d["damage"], nlohmann::ordered_json({"events block 1 with a wrong checksum"}));
  }
}

TEST(Replay, AFileOfAnotherTaskThatIsDamagedDoesNotHinder) {
  const synthetic::Folder folder;
  recorded_run(folder.file("one"));
  damage(folder.file("one"), "title: 8-0 polypropylene", folder.file("suture"));
  const Call c = call({"replay", folder.file("suture"), "--json"});
  EXPECT_EQ(c.code, kBadInput);
  EXPECT_NE(c.err.find("source models/suture/"), std::string::npos) << c.err;
}

TEST(Replay, WhatIsNoRecordingIsBadInput) {
  const synthetic::Folder folder;
  std::ofstream(folder.file("text")) << "not a recording";
  expect_refused({"replay", folder.file("text"), "--json"}, {folder.file("text"), "expected"});
  expect_refused({"replay", folder.file("absent"), "--json"}, {folder.file("absent"), "expected"});
}

}  // namespace replay_test
}  // namespace filum
