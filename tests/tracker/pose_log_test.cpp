#include "tracker/pose_log.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "tests/refusal.h"
#include "tests/session/disk_limit.h"

namespace filum {
namespace pose_log_test {

namespace fs = std::filesystem;

class PoseLogTest : public testing::Test {
 protected:
  PoseLogTest() : folder_(fs::temp_directory_path() / ("filum_pose_log_" + std::to_string(::getpid()))), path_((folder_ / "poses.csv").string()) {
    fs::create_directories(folder_);
  }
  ~PoseLogTest() override { fs::remove_all(folder_); }

  std::vector<std::string> lines() const {
    std::vector<std::string> all;
    std::ifstream file(path_);
    for (std::string line; std::getline(file, line);) all.push_back(line);
    return all;
  }

  fs::path folder_;
  std::string path_;
};

std::vector<double> numbers(const std::string& row) {
  std::vector<double> cells;
  std::stringstream stream(row);
  for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(std::stod(cell));
  return cells;
}

/// Only the upper triangle is a number of its own: the lower one is not to be written.
MarkerPose seen(double residual = 0.1234) {
  MarkerPose pose;
  pose.tool = 2;
  pose.marker = 17;
  pose.residual = residual;
  pose.X_CT.p = Vec3(9, 9, 9);
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) pose.covariance(i, j) = j >= i ? 1e-9 * (10 * i + j + 1) : 7.0;
  return pose;
}

Pose sent(double x) {
  Pose X;
  X.p = Vec3(x, -0.0125, 0.25);
  X.q = Quat(Eigen::AngleAxisd(0.8, Vec3(2, -1, 3).normalized()));
  return X;
}

InputError refusal(const std::string& path) { return refusal_by([&] { PoseLog log(path); }); }

TEST_F(PoseLogTest, TheHeadNamesEveryColumnWithItsUnit) {
  { const PoseLog log(path_); }
  ASSERT_EQ(lines().size(), 1u);
  EXPECT_EQ(lines()[0], "time_s,tool,marker,x_m,y_m,z_m,qw,qx,qy,qz,residual_px,"
                        "c00,c01,c02,c03,c04,c05,c11,c12,c13,c14,c15,c22,c23,c24,c25,c33,c34,c35,c44,c45,c55");
}

TEST_F(PoseLogTest, APoseIsReadBackInMetresAndAsWXYZ) {
  { PoseLog(path_).add(12.345678, seen(), sent(0.0123456)); }
  ASSERT_EQ(lines().size(), 2u);
  const auto row = numbers(lines()[1]);
  ASSERT_EQ(row.size(), 32u);
  EXPECT_NEAR(row[0], 12.345678, 1e-9);
  EXPECT_EQ(row[1], 2.0);
  EXPECT_EQ(row[2], 17.0);
  const Vec3 p(row[3], row[4], row[5]);
  EXPECT_LT((p - sent(0.0123456).p).norm(), 1e-7) << "what was sent, not what the camera saw; to a tenth of a micrometre";
  const Quat q(row[6], row[7], row[8], row[9]);
  EXPECT_LT((q.coeffs() - sent(0.0).q.coeffs()).norm(), 2e-9);
  EXPECT_NEAR(row[10], 0.1234, 1e-9);
}

TEST_F(PoseLogTest, TheCovarianceIsItsUpperTriangleRowByRow) {
  const MarkerPose pose = seen();
  { PoseLog(path_).add(0.0, pose, {}); }
  const auto row = numbers(lines().at(1));
  ASSERT_EQ(row.size(), 32u);
  std::size_t at = 11;
  for (int i = 0; i < 6; ++i)
    for (int j = i; j < 6; ++j, ++at) EXPECT_NEAR(row[at], pose.covariance(i, j), 1e-6 * pose.covariance(i, j)) << i << " " << j;
}

TEST_F(PoseLogTest, EachPoseHasALineOfItsOwnInTurn) {
  {
    PoseLog log(path_);
    for (int k = 0; k < 5; ++k) log.add(0.04 * k, seen(0.01 * k), sent(1e-3 * k));
  }
  const auto all = lines();
  ASSERT_EQ(all.size(), 6u);
  for (int k = 0; k < 5; ++k) {
    const auto row = numbers(all[static_cast<std::size_t>(k) + 1]);
    ASSERT_EQ(row.size(), 32u);
    EXPECT_NEAR(row[0], 0.04 * k, 1e-9);
    EXPECT_NEAR(row[3], 1e-3 * k, 1e-9);
    EXPECT_NEAR(row[10], 0.01 * k, 1e-9);
  }
}

TEST_F(PoseLogTest, WhatWasAddedIsInTheFileBeforeTheLogEnds) {
  PoseLog log(path_);
  log.add(0.0, seen(), {});
  log.add(0.04, seen(), {});
  EXPECT_EQ(lines().size(), 3u) << "the program may be killed";
}

TEST_F(PoseLogTest, AFullDiskIsSaidWithTheFilesName) {
  PoseLog log(path_);
  const DiskLimit full(4096);
  try {
    for (int k = 0; k < 100; ++k) log.add(0.04 * k, seen(), {});
    FAIL() << "a hundred rows in 4096 bytes";
  } catch (const InputError& error) {
    ADD_FAILURE() << "no bad input: " << error.what();
  } catch (const std::exception& error) {
    EXPECT_NE(std::string(error.what()).find(path_), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("space left"), std::string::npos) << error.what();
  }
}

TEST_F(PoseLogTest, AFileThatIsThereIsNamedAndLeftAlone) {
  std::ofstream(path_) << "of the day before\n";
  const InputError error = refusal(path_);
  EXPECT_EQ(error.file, "--log");
  EXPECT_EQ(error.field, "file");
  EXPECT_EQ(error.value, path_);
  EXPECT_EQ(error.expected, "a file that does not exist yet");
  EXPECT_EQ(lines(), std::vector<std::string>{"of the day before"});
}

TEST_F(PoseLogTest, WhereNoFileCanBeItIsNamed) {
  const std::string nowhere = (folder_ / "none" / "poses.csv").string();
  const InputError error = refusal(nowhere);
  EXPECT_EQ(error.file, "--log");
  EXPECT_EQ(error.value, nowhere);
  EXPECT_EQ(error.expected, "a file that can be written");
  EXPECT_EQ(refusal(folder_.string()).value, folder_.string());
  const std::string too_long = (folder_ / std::string(300, 'a')).string();
  EXPECT_EQ(refusal(too_long).expected, "a file that can be written") << "the system refuses such a name";
}

}  // namespace pose_log_test
}  // namespace filum
