#include "cli/program.h"

#include <gtest/gtest.h>

#include "program_call.h"

namespace filum {
namespace program_test {

const char* const kCommands[] = {"train", "run", "replay", "score", "export", "list", "validate", "bench", "analyse", "calibrate", "doctor", "reconcile", "import"};

TEST(Program, EveryCommandExplainsItselfAndIsListed) {
  const Call all = call({"--help"});
  EXPECT_EQ(all.code, kDone);
  for (const char* name : kCommands) {
    EXPECT_NE(all.out.find(std::string("  ") + name + " "), std::string::npos) << name;
    const Call help = call({name, "--help"});
    EXPECT_EQ(help.code, kDone) << name;
    EXPECT_NE(help.out.find("Usage"), std::string::npos) << name;
    EXPECT_EQ(help.err, "") << name;
  }
  EXPECT_NE(all.out.find("  mesh "), std::string::npos);  // its help is that of another program: mesh_test.cpp
  EXPECT_EQ(call({"--version"}).out, program_text() + "\n");
}

TEST(Program, WhatItDoesNotKnowIsBadInputAndSaidOnStderr) {
  expect_refused({}, {"subcommand"});
  expect_refused({"nonsense"}, {"found nonsense", "expected one of those that `filum --help` lists"});
  expect_refused({"list", "--jsn"}, {"filum: ", "--jsn", "(`filum list --help` tells what is expected)"});
  expect_refused({"calibrate", "forceps"}, {"--out is required (`filum calibrate forceps --help`"});
  expect_refused({"score"}, {"file"});
  expect_refused({"run", "tip-hold", "--motion-scale", "0"}, {"--motion-scale"});
}

/// As of a script's variable that was not set.
TEST(Program, AnOptionWithoutAValueIsNotTakenForNoOption) {
  for (const std::vector<std::string>& words : {std::vector<std::string>{"run", "tip-hold", "--record", ""}, {"run", "tip-hold", "--model", ""}, {"train", "--store", ""}, {"replay", ""}, {"calibrate", "forceps", "--out", ""}})
    expect_refused(words, {words.size() == 2 ? "file" : words[words.size() - 2], "found nothing, expected a value"});
}

TEST(Program, NumbersThatAreNoneAreRefused) {
  for (const std::vector<std::string>& words : {std::vector<std::string>{"run", "tip-hold", "--longest", "nan"}, {"run", "tip-hold", "--motion-scale", "nan"}, {"bench", "--wild", "1", "--wild-seconds", "nan", "tip-hold"}})
    expect_refused(words, {"found nan", "a number from"});
}

TEST(Program, WhatCouldNotBeWrittenIsNotCalledDone) {
  std::FILE* full = std::fopen("/dev/full", "w");
  ASSERT_NE(full, nullptr);
  const Ear said;
  const char* words[] = {"filum", "list", "--json"};
  EXPECT_EQ(program(3, words, {stdin, full, said.stream()}), kFailed);
  EXPECT_NE(said.heard().find("a full disk"), std::string::npos);
  std::fclose(full);
}

}  // namespace program_test
}  // namespace filum
