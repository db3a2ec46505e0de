// filum score: a recording scored anew comes to what its run said, and says when this build steps it otherwise.

#include <gtest/gtest.h>

#include <fstream>

#include "altered_recording.h"
#include "program_call.h"
#include "tests/session/synthetic.h"

namespace filum {
namespace score_test {

TEST(Score, ARecordingScoresAsItsRunDid) {
  const synthetic::Folder folder;
  const auto run = nlohmann::ordered_json::parse(recorded_run(folder.file("one")));
  const auto d = call({"score", folder.file("one"), "--json"}).json();
  EXPECT_TRUE(d["replay_identical"].get<bool>());
  for (const char* part : {"task", "finished", "passed", "seconds", "score", "knot", "events"}) EXPECT_EQ(d.at(part), run.at(part)) << part;
}

TEST(Score, TextGivesEveryItemWithItsReason) {
  const synthetic::Folder folder;
  const auto run = nlohmann::ordered_json::parse(recorded_run(folder.file("one")));
  const Call c = call({"score", folder.file("one")});
  EXPECT_EQ(c.code, kDone);
  EXPECT_EQ(c.err, "");
  for (const auto& item : run["score"]["items"]) EXPECT_NE(c.out.find(item["why"].get<std::string>()), std::string::npos) << c.out;
}

TEST(Score, WhatStepsOtherwiseHereIsSaid) {
  const synthetic::Folder folder;
  recorded_run(folder.file("one"));
  write_altered(folder.file("one"), folder.file("altered"));
  EXPECT_FALSE(call({"score", folder.file("altered"), "--json"}).json()["replay_identical"].get<bool>());
  EXPECT_NE(call({"score", folder.file("altered")}).err.find("steps the recording differently"), std::string::npos);
  expect_refused({"score", folder.file("absent")}, {folder.file("absent"), "expected"});
}

}  // namespace score_test
}  // namespace filum
