// filum reconcile in this process: keys of the report, exit codes, words. The verdicts are tested in tests/reconcile, many datasets and what is
// left behind in reconcile_command_test.sh.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "base/rng.h"
#include "program_call.h"
#include "tests/reconcile/records.h"

namespace filum {
namespace reconcile_command_test {

namespace fs = std::filesystem;

/// A linear block of 2 kPa, 25 mm2 over 5 mm, so 10 mN a mm.
void write_block(const reconcile::Folder& all, const std::string& name) {
  fs::create_directories(all.file(name));
  std::string trials;
  Rng rng(3);
  for (const auto& [file, speed] : {std::pair{"a.csv", 1.0}, {"b.csv", 4.0}}) {
    trials += std::string("  - { file: ") + file + ", protocol: { mode: compression, rate: \"1 mm/s\" } }\n";
    all.write(name + "/" + file, reconcile::block_csv([&](double, double u, int) { return 10.0 * u + 0.02 * rng.normal(); }, speed, 120));
  }
  all.write(name + "/experiment.yaml", reconcile::block_yaml(trials));
}

TEST(ReconcileCommand, JsonIsTheReportOfTheContract) {
  const reconcile::Folder folder;
  write_block(folder, "block");
  const auto d = call({"reconcile", folder.file("block"), "--out", folder.file("out"), "--json"}).json();
  expect_keys(d, {"format", "dataset", "rig", "verdict", "effects", "baseline", "rivals", "gap", "where", "not_testable", "partial", "next_experiment", "seconds"});
  EXPECT_EQ(d["format"], "filum-reconcile/1");
  EXPECT_EQ(d["dataset"], "block");
  EXPECT_EQ(d["rig"], "tissue-block");
  EXPECT_EQ(d["verdict"], "agree");
  EXPECT_TRUE(d["effects"].empty());
  EXPECT_NEAR(d["baseline"]["youngs_modulus"]["value"].get<double>(), 2000.0, 60.0);
  expect_keys(d["gap"], {"noise", "fit", "held_out"});
  std::ifstream written(folder.file("out/report.json"));
  EXPECT_EQ(nlohmann::ordered_json::parse(written), d);
  EXPECT_GT(fs::file_size(folder.file("out/report.html")), 1000u);
  EXPECT_FALSE(fs::exists(folder.file("out/model.yaml")));
}

TEST(ReconcileCommand, TextSaysVerdictAndWhereTheReportIs) {
  const reconcile::Folder folder;
  write_block(folder, "block");
  const Call c = call({"reconcile", folder.file("block"), "--out", folder.file("out"), "--threads", "1"});
  EXPECT_EQ(c.code, kDone);
  EXPECT_EQ(c.out.find("block: agree\n"), 0u) << c.out;
  EXPECT_NE(c.out.find(folder.file("out") + "/report.html"), std::string::npos) << c.out;
  EXPECT_EQ(c.err.find('#'), std::string::npos) << "a progress bar where nobody looks: " << c.err;
}

TEST(ReconcileCommand, OfManyTheBadOnesAreNamedAndTheOthersSolved) {
  const reconcile::Folder folder;
  write_block(folder, "all/good");
  write_block(folder, "all/bad");
  folder.write("all/bad/b.csv", "t,u,F\n0,0,0\n1,0.1,x\n");
  const Call c = call({"reconcile", "--all", folder.file("all"), "--out", folder.file("out")});
  EXPECT_EQ(c.code, kBadInput);
  EXPECT_NE(c.err.find("good: agree"), std::string::npos) << c.err;
  EXPECT_NE(c.err.find("bad: refused: "), std::string::npos) << c.err;
  EXPECT_NE(c.err.find("b.csv:3"), std::string::npos) << c.err;
  EXPECT_TRUE(fs::exists(folder.file("out/good/report.json")));
  EXPECT_FALSE(fs::exists(folder.file("out/bad")));
}

TEST(ReconcileCommand, WhatIsWrongInADatasetIsNamedByFileLineAndColumn) {
  const reconcile::Folder folder;
  write_block(folder, "block");
  folder.write("block/b.csv", "t,u,F\n0,0,0\n0,0.1,1\n");
  const std::string out = folder.file("out");
  expect_refused({"reconcile", folder.file("block"), "--out", out}, {"b.csv:3", "column t", "expected"});
  expect_refused({"reconcile", folder.file("none"), "--out", out}, {folder.file("none"), "expected a folder with experiment.yaml"});
  expect_refused({"reconcile", "--out", out}, {"DATASET", "found nothing", "one folder, or --all FOLDER"});
  expect_refused({"reconcile", folder.file("block"), "--all", folder.path(), "--out", out}, {"one folder, or --all FOLDER"});
  expect_refused({"reconcile", "--all", folder.file("block/b.csv"), "--out", out}, {"--all", "a folder of datasets"});
  EXPECT_FALSE(fs::exists(out));
  expect_refused({"reconcile", folder.file("block"), "--out", folder.file("block/b.csv")}, {"--out", "b.csv", "expected a folder that can be written"});
  expect_refused({"reconcile", folder.file("block"), "--again", "--out", out}, {"--again", folder.file("block"), "expected --all FOLDER beside it"});
}

TEST(ReconcileCommand, AReportThatWasCutIsNoneAndTheDatasetSolvedAgain) {
  const reconcile::Folder folder;
  write_block(folder, "all/block");
  const std::vector<std::string> words = {"reconcile", "--all", folder.file("all"), "--out", folder.file("out")};
  EXPECT_NE(call(words).err.find("1/1 block: agree"), std::string::npos);
  EXPECT_EQ(call(words).err, "") << "it has a report";
  const std::string report = folder.file("out/block/report.json");
  fs::resize_file(report, fs::file_size(report) / 2);
  EXPECT_NE(call(words).err.find("1/1 block: agree"), std::string::npos);
  std::ifstream written(report);
  EXPECT_EQ(nlohmann::ordered_json::parse(written)["verdict"], "agree");
}

}  // namespace reconcile_command_test
}  // namespace filum
