#include "anatomy/mesh_program.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "anatomy/scans.h"

namespace filum {
namespace mesh_program_test {

namespace fs = std::filesystem;

class MeshProgram : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "filum-mesh-XXXXXX").string();
    ASSERT_NE(::mkdtemp(name.data()), nullptr);
    folder_ = name;
    scans::write(file("head.nii"), scans::header(72, 2.0f), scans::ball_head(72, 2.0));
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::string file(const std::string& name) const { return (folder_ / name).string(); }
  int call(std::vector<std::string> words) {
    words.insert(words.begin(), "filum_mesh");
    std::vector<const char*> argv;
    for (const std::string& word : words) argv.push_back(word.c_str());
    char *out = nullptr, *err = nullptr;
    std::size_t out_size = 0, err_size = 0;
    std::FILE *to = ::open_memstream(&out, &out_size), *faults = ::open_memstream(&err, &err_size);
    const int code = mesh_program(static_cast<int>(argv.size()), argv.data(), to, faults);
    std::fclose(to);
    std::fclose(faults);
    out_.assign(out, out_size);
    err_.assign(err, err_size);
    std::free(out);
    std::free(err);
    return code;
  }
  fs::path folder_;
  std::string out_, err_;
};

TEST_F(MeshProgram, ABallHeadGivesAMeshAModelAndAReport) {
  ASSERT_EQ(call({file("head.nii"), "--at", "0,0,50", "--radius", "20", "--depth", "20", "--fine", "5", "--coarse", "8", "--out", file("region"), "--json"}), 0) << err_;
  const auto d = nlohmann::json::parse(out_);
  EXPECT_GT(d["nodes"].get<int>(), 100);
  EXPECT_GT(d["quality"]["worst_radius_ratio"].get<double>(), 0.02);
  EXPECT_NEAR(d["scan"]["brain_ml"].get<double>(), 381.7, 0.03 * 381.7);  // 4/3 pi (45 mm)^3
  EXPECT_GT(d["grey_ml"].get<double>(), 0.0);
  EXPECT_NEAR(d["window"]["outward"][2].get<double>(), 1.0, 1e-3);  // seen from the middle of the ball
  std::ifstream report(file("region/report.json"));
  EXPECT_EQ(nlohmann::json::parse(report), d);
  for (const char* made : {"region/mesh.txt", "region/brain.yaml"}) EXPECT_GT(fs::file_size(file(made)), 100u) << made;
}

TEST_F(MeshProgram, WhatIsAskedWronglyIsNamedAndNothingIsWritten) {
  const auto refused = [&](const std::vector<std::string>& words, const char* said) {
    EXPECT_EQ(call(words), 2) << said;
    EXPECT_NE(err_.find(said), std::string::npos) << err_;
    EXPECT_EQ(out_, "");
  };
  refused({file("head.nii"), "--out", file("x")}, "--at");
  refused({file("head.nii"), "--at", "0,50", "--out", file("x")}, "--at: place: found 2 numbers, expected x,y,z in mm");
  refused({file("none.nii"), "--at", "0,0,50", "--out", file("x")}, "none.nii");
  refused({file("head.nii"), "--at", "0,0,50", "--radius", "500", "--out", file("x")}, "head.nii");
  refused({file("head.nii"), "--at", "0,0,50", "--out", file("head.nii")}, "--out: folder: found ");
  EXPECT_FALSE(fs::exists(file("x")));
  EXPECT_EQ(call({"--help"}), 0);
  EXPECT_NE(out_.find("--extracted"), std::string::npos);
  EXPECT_EQ(err_, "");
}

}  // namespace mesh_program_test
}  // namespace filum
