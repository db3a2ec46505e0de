// filum export: the files it names are there and hold the run; what the tables hold is tested in tests/session.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "program_call.h"
#include "tests/session/disk_limit.h"
#include "tests/session/synthetic.h"

namespace filum {
namespace export_test {

namespace fs = std::filesystem;

std::ptrdiff_t lines_in(const std::string& file) {
  std::ifstream in(file);
  return std::count(std::istreambuf_iterator<char>(in), {}, '\n');
}

class Export : public testing::Test {
 protected:
  void SetUp() override { run_ = nlohmann::ordered_json::parse(recorded_run(folder_.file("one"))); }
  std::vector<std::string> files(const std::string& format) {
    return call({"export", folder_.file("one"), "--format", format, "--out", folder_.file(format), "--json"}).json()["files"];
  }
  synthetic::Folder folder_;
  nlohmann::ordered_json run_;
};

TEST_F(Export, CsvHoldsEveryStepOfTheSceneAndADictionary) {
  bool simulated = false, dictionary = false;
  for (const std::string& file : files("csv")) {
    ASSERT_TRUE(fs::exists(file)) << file;
    const std::string name = fs::path(file).filename();
    if (name == "simulated.csv") {
      simulated = true;
      EXPECT_EQ(lines_in(file), run_["steps"].get<int>() + 1);
    }
    dictionary = dictionary || fs::path(file).extension() == ".json" || name.find("dictionary") != std::string::npos;
  }
  EXPECT_TRUE(simulated);
  EXPECT_TRUE(dictionary);
}

TEST_F(Export, TheOtherFormatsWriteWhatTheyName) {
  for (const char* format : {"hdf5", "bids"}) {
    const auto written = files(format);
    EXPECT_FALSE(written.empty()) << format;
    for (const std::string& file : written) EXPECT_GT(fs::file_size(file), 0u) << file;
  }
  const Call text = call({"export", folder_.file("one"), "--format", "hdf5", "--out", folder_.file("again")});
  EXPECT_EQ(text.out.find(folder_.file("again")), 0u) << text.out;
}

TEST_F(Export, AWrongFormatFileOrFolderIsNamed) {
  expect_refused({"export", folder_.file("one"), "--format", "xml", "--out", folder_.file("x")}, {"--format", "xml", "csv"});
  expect_refused({"export", folder_.file("none"), "--out", folder_.file("x")}, {folder_.file("none"), "expected"});
  EXPECT_FALSE(fs::exists(folder_.file("x")));
  std::ofstream(folder_.file("file")) << "in the way";
  expect_refused({"export", folder_.file("one"), "--out", folder_.file("file")}, {folder_.file("file"), "expected"});
}

TEST_F(Export, AnExportThatIsThereIsNotWrittenOver) {
  for (const char* format : {"csv", "hdf5"}) {
    files(format);
    expect_refused({"export", folder_.file("one"), "--format", format, "--out", folder_.file(format)}, {folder_.file(format), "a file that exists", "an export is never written over"});
  }
  files("bids");
  EXPECT_FALSE(files("bids").empty()) << "a dataset is joined";
}

TEST_F(Export, AFullDiskIsSaidAndNothingHalfIsLeft) {
  recorded_run(folder_.file("long"), "4");
  const DiskLimit limit(512 << 10);  // more than a file of the scene, less than any export of four seconds
  for (const char* format : {"csv", "hdf5"}) {
    const Call c = call({"export", folder_.file("long"), "--format", format, "--out", folder_.file("full")});
    EXPECT_EQ(c.code, kFailed) << c.err;
    EXPECT_EQ(c.out, "");
    EXPECT_NE(c.err.find("a disk with space left"), std::string::npos) << c.err;
    EXPECT_FALSE(fs::exists(folder_.file("full")));
  }
}

}  // namespace export_test
}  // namespace filum
