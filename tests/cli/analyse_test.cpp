// filum analyse: the keys of its report, its pages, and refusals; the measures themselves are tested in tests/analysis.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "altered_recording.h"
#include "cli/session_files.h"
#include "program_call.h"
#include "tests/session/synthetic.h"

namespace filum {
namespace analyse_test {

namespace fs = std::filesystem;

class Analyse : public testing::Test {
 protected:
  void SetUp() override { recorded_run(folder_.file("one"), "4"); }
  synthetic::Folder folder_;
};

TEST_F(Analyse, JsonHoldsTremorSmoothnessAndGraspForceOfEachTool) {
  const auto d = call({"analyse", folder_.file("one"), "--json"}).json();
  expect_keys(d, {"tremor", "smoothness", "grasp_force"});
  ASSERT_FALSE(d["tremor"].empty());
  for (const auto& t : d["tremor"]) {
    expect_keys(t, {"tool", "space", "window", "resolved"});
    EXPECT_TRUE(t["resolved"].get<bool>() || !t["why"].get<std::string>().empty()) << t;
  }
  const Call text = call({"analyse", folder_.file("one")});
  EXPECT_EQ(text.code, kDone);
  EXPECT_EQ(text.out.find("tremor, tool "), 0u) << text.out;
}

TEST_F(Analyse, PlotAndPageAreWrittenWhereAskedFor) {
  EXPECT_EQ(call({"analyse", folder_.file("one"), "--plot", folder_.file("p.svg"), "--page", folder_.file("p.html")}).code, kDone);
  std::string first;
  std::getline(std::ifstream(folder_.file("p.svg")), first);
  EXPECT_EQ(first.find("<svg"), 0u);
  EXPECT_GT(fs::file_size(folder_.file("p.html")), 500u);
  expect_refused({"analyse", folder_.file("one"), "--page", folder_.file("none/p.html")}, {"--page", folder_.file("none/p.html"), "a file that can be written"});
}

TEST_F(Analyse, ARecordingIsNeverWrittenOver) {
  const auto bytes = fs::file_size(folder_.file("one"));
  for (const char* option : {"--plot", "--page"})
    expect_refused({"analyse", folder_.file("one"), option, folder_.file("one")}, {option, folder_.file("one"), "a recording is never written over"});
  EXPECT_EQ(fs::file_size(folder_.file("one")), bytes);
}

TEST_F(Analyse, DamageBesideWhatItReadsIsTold) {
  EXPECT_TRUE(call({"analyse", folder_.file("one"), "--json"}).json()["damage"].empty());
  damage(folder_.file("one"), "latex-card", folder_.file("bad"));
  for (const std::vector<std::string>& words : {std::vector<std::string>{"analyse", folder_.file("bad"), "--json"}, {"analyse", folder_.file("one"), "--clamped", folder_.file("bad"), "--json"}}) {
    const Call c = call(words);
    EXPECT_EQ(c.code, kBadInput);
    EXPECT_NE(c.err.find(folder_.file("bad") + ": recording: found "), std::string::npos) << c.err;
    EXPECT_EQ(nlohmann::ordered_json::parse(c.out)["damage"].size(), 1u) << c.out;
  }
}

TEST_F(Analyse, ASqueezeThatNoDeviceMeasuredIsTheSimulations) {
  const RecordedSession session = open_session(folder_.file("one"));
  ASSERT_FALSE(session.tools.empty());
  for (const ToolSeries& tool : session.tools) {
    EXPECT_EQ(tool.grip.source, "simulation");
    EXPECT_GT(tool.grip.force.size(), 1000u);
  }
  expect_refused({"analyse", folder_.file("none")}, {folder_.file("none"), "expected"});
  expect_refused({"analyse", folder_.file("one"), "--clamped", folder_.file("floor")}, {folder_.file("floor"), "expected"});
}

}  // namespace analyse_test
}  // namespace filum
