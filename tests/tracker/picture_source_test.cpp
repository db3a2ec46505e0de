#include "tracker/picture_source.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "base/error.h"

namespace filum {
namespace picture_source_test {

namespace fs = std::filesystem;

class PictureSourceTest : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "filum-video-XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  void TearDown() override { fs::remove_all(folder_); }
  /// A video of 40 pictures, the k-th of brightness 5 k.
  std::string video() {
    const std::string path = folder_ + "/video.avi";
    cv::VideoWriter writer(path, cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 20.0, {160, 120}, true);
    for (int k = 0; k < 40; ++k) writer.write(cv::Mat(120, 160, CV_8UC3, cv::Scalar::all(5 * k)));
    return path;
  }
  static int count(const std::string& path) {
    PictureSource source(path);
    int n = 0;
    for (cv::Mat grey; source.read(grey); ++n) {
      EXPECT_EQ(grey.size(), cv::Size(160, 120));
      EXPECT_EQ(grey.type(), CV_8U);
    }
    return n;
  }
  std::string folder_;
};

TEST_F(PictureSourceTest, AVideoIsReadWithItsTimes) {
  PictureSource source(video());
  EXPECT_FALSE(source.is_camera());
  cv::Mat grey;
  for (int k = 0; k < 40; ++k) {
    ASSERT_TRUE(source.read(grey)) << k;
    EXPECT_NEAR(source.seconds(), 0.05 * k, 1e-9);
    EXPECT_NEAR(grey.at<unsigned char>(60, 80), 5 * k, 4);
  }
  EXPECT_FALSE(source.read(grey)) << "its end";
}

TEST_F(PictureSourceTest, WhatIsNoVideoIsRefusedByName) {
  const std::string junk = folder_ + "/junk.avi", empty = folder_ + "/empty.mp4";
  std::ofstream(junk) << "RIFF, but that is all there is of a video in this file";
  std::ofstream(empty).flush();
  for (const std::string& path : {junk, empty, folder_ + "/none.avi", folder_, std::string("99")}) {
    try {
      PictureSource source(path);
      FAIL() << path;
    } catch (const InputError& error) {
      EXPECT_EQ(error.value, path);
    }
  }
}

TEST_F(PictureSourceTest, ADamagedVideoEndsAndDoesNotCrash) {
  const std::string path = video();
  std::ifstream whole(path, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(whole)), {});
  std::ofstream(folder_ + "/cut.avi", std::ios::binary) << bytes.substr(0, bytes.size() / 2);
  try {
    EXPECT_LT(count(folder_ + "/cut.avi"), 40);
  } catch (const InputError&) {
    // without its index the file may not count as a video at all
  }
  std::string turned = bytes;
  for (std::size_t k = 3000; k < turned.size(); k += 97) turned[k] = static_cast<char>(turned[k] ^ 0x55);
  std::ofstream(folder_ + "/turned.avi", std::ios::binary) << turned;
  try {
    EXPECT_LE(count(folder_ + "/turned.avi"), 40);
  } catch (const InputError&) {
  }
}

}  // namespace picture_source_test
}  // namespace filum
