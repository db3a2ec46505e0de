// filum run: the keys of the contract, the same state every time, and what is wrong with the input in words.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>

#include "program_call.h"
#include "tests/session/synthetic.h"

namespace filum {
namespace run_test {

using Json = nlohmann::ordered_json;

Json run_of(const char* task, const char* seconds) { return call({"run", task, "--input", "demo", "--longest", seconds, "--json"}).json(); }

void expect_score(const Json& score) {
  double sum = 0.0;
  ASSERT_FALSE(score["items"].empty());
  for (const Json& item : score["items"]) {
    expect_keys(item, {"name", "value", "unit", "points", "why"});
    sum += item["points"].get<double>();
    EXPECT_FALSE(item["why"].get<std::string>().empty()) << item["name"];
  }
  EXPECT_NEAR(score["total"].get<double>(), sum, 1e-6);
}

TEST(Run, JsonHoldsTheKeysOfTheContractAndEqualRunsEndInTheSameState) {
  const Json d = run_of("tip-hold", "0.5");
  expect_keys(d, {"task", "finished", "passed", "seconds", "real_time_factor", "overruns", "score", "events", "state_hash", "steps", "scene_seconds", "devices"});
  ASSERT_EQ(d["devices"].size(), 1u);
  expect_keys(d["devices"][0], {"name", "state", "received", "lost", "corrupt", "rejected"});
  EXPECT_GT(d["devices"][0]["received"].get<int>(), 100);
  EXPECT_EQ(d["devices"][0]["lost"], 0);
  EXPECT_EQ(d["task"], "tip-hold");
  EXPECT_FALSE(d["finished"].get<bool>());
  EXPECT_FALSE(d["passed"].get<bool>());
  EXPECT_NEAR(d["scene_seconds"].get<double>(), 0.5, 0.01);
  EXPECT_GT(d["real_time_factor"].get<double>(), 0.0);
  expect_score(d["score"]);
  EXPECT_TRUE(std::regex_match(d["state_hash"].get<std::string>(), std::regex("[0-9a-f]{16}")));
  EXPECT_EQ(run_of("tip-hold", "0.5")["state_hash"], d["state_hash"]);
  EXPECT_NE(run_of("tip-hold", "0.52")["state_hash"], d["state_hash"]);
}

TEST(Run, ATaskTellsWhatItMeasures) {
  const Json knot = run_of("knot-square", "0.1");
  expect_keys(knot["knot"], {"class", "security_newton"});
  EXPECT_EQ(knot["knot"]["class"], "unknot");
  expect_score(knot["score"]);
  const Json press = run_of("press-to-target", "0.1");
  expect_keys(press["pressure"], {"peak_mmhg", "dose", "time_in_band"});
  EXPECT_TRUE(press["knot"].is_null());
  const Json stitch = run_of("vessel-stitch", "0.1");
  expect_keys(stitch, {"stitches", "lapses", "leak", "handling"});
  expect_keys(stitch["handling"], {"adventitia", "through_wall", "slipped", "most_pull_n"});
  EXPECT_TRUE(stitch["stitches"].empty());
  EXPECT_EQ(stitch["leak"]["per_sector"].size(), 8u);
  EXPECT_NEAR(stitch["leak"]["round_m"].get<double>(), 3.14 * 0.9e-3, 0.5e-3) << "round a tube of 1 mm";
  const Json& edge = stitch["leak"]["edge"];
  ASSERT_GE(edge.size(), 20u);
  for (std::size_t k = 0; k < edge.size(); ++k) {
    EXPECT_NEAR(edge[k]["angle_deg"].get<double>(), 360.0 * static_cast<double>(k) / static_cast<double>(edge.size()), 1.0);
    EXPECT_GT(edge[k]["gap_m"].get<double>(), 0.1e-3) << "nothing is sewn";
  }
}

TEST(Run, TextSaysTheSameAsJson) {
  const Json d = run_of("tip-hold", "0.5");
  const Call text = call({"run", "tip-hold", "--input", "demo", "--longest", "0.5"});
  EXPECT_EQ(text.code, kDone);
  EXPECT_NE(text.out.find("not finished, not passed"), std::string::npos) << text.out;
  EXPECT_NE(text.out.find("state " + d["state_hash"].get<std::string>() + "\n"), std::string::npos) << text.out;
  const auto& device = d["devices"][0];
  EXPECT_NE(text.out.find(device["name"].get<std::string>() + ": " + device["received"].dump() + " samples received, 0 lost, 0 frames damaged"), std::string::npos) << text.out;
}

TEST(Run, WhatIsWrongIsNamedWithWhatWasExpected) {
  const synthetic::Folder folder;
  const std::string script = folder.file("hand.yaml"), kept = folder.file("kept");
  std::ofstream(script) << "format: filum-demonstration/1\ntitle: A hand\ntools:\n  - tool: 0\n    keys:\n"
                           "      - { t: 0 s, p: [.nan mm, 0 mm, 6 mm], handle: [0, 0, 1], opening: [0, 1, 0], grip: 12 deg }\n";
  std::ofstream(kept) << "another's";
  expect_refused({"run", "no-such-task", "--json"}, {"task", "found no-such-task", "expected one of:", "knot-square"});
  expect_refused({"run", "tip-hold", "--input", "no-such-input"}, {"--input", "found no-such-input", "expected demo, serial:PATH"});
  expect_refused({"run", "tip-hold", "--input", script}, {"hand.yaml", "nan mm"});
  expect_refused({"run", "tip-hold", "--input", "haptic:99999"}, {"port", "found 99999", "ADDRESS:PORT"});
  expect_refused({"run", "tip-hold", "--root", folder.file("")}, {"--root", "expected a folder with models/ and curricula/"});
  expect_refused({"run", "tip-hold", "--record", kept}, {kept, "expected"});
  expect_refused({"run", "tip-hold", "--record", folder.file("new"), "--code", "Jane Doe"}, {"Jane Doe", "expected"});
  expect_refused({"run", "tip-hold", "--stiffness", "2"}, {"--stiffness", "expected a task of brain retraction"});
  expect_refused({"run", "tip-hold", "--code", "P01"}, {"--code", "found P01", "expected --record FILE beside it"});
  for (const char* option : {"--record", "--model", "--forceps"}) expect_refused({"run", "tip-hold", option, ""}, {option, "found nothing", "expected"});
  std::string text;
  std::getline(std::ifstream(kept), text);
  EXPECT_EQ(text, "another's");
}

}  // namespace run_test
}  // namespace filum
