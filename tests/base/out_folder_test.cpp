#include "base/out_folder.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "base/error.h"

namespace filum {
namespace out_folder_test {

namespace fs = std::filesystem;

class OutFolder : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "filum-out-XXXXXX").string();
    ASSERT_NE(::mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  void TearDown() override { fs::remove_all(folder_); }
  static std::string refusal(const fs::path& folder) {
    try {
      require_out_folder("--out", folder.string());
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
  fs::path folder_;
};

TEST_F(OutFolder, WhatCanBeMadeIsTakenAndNotMade) {
  EXPECT_EQ(refusal(folder_), "");
  EXPECT_EQ(refusal(folder_ / "new" / "deep/"), "");
  EXPECT_EQ(refusal("new"), "") << "below where the program was started";
  EXPECT_FALSE(fs::exists(folder_ / "new") || fs::exists("new"));
}

TEST_F(OutFolder, WhatCannotBeAFolderIsNamedWithWhy) {
  std::ofstream(folder_ / "file") << "in the way";
  EXPECT_EQ(refusal(folder_ / "file/below"), "--out: folder: found " + (folder_ / "file/below").string() + " (" + (folder_ / "file").string() + " is a file), expected a folder that can be written, or can be made");
  EXPECT_NE(refusal(folder_ / "file"), "");
  EXPECT_NE(refusal(folder_ / std::string(300, 'a')).find("name too long"), std::string::npos) << refusal(folder_ / std::string(300, 'a'));
  EXPECT_NE(refusal(""), "");
}

TEST_F(OutFolder, AFolderThatMayNotBeWrittenIsSaidToBeNone) {
  fs::permissions(folder_, fs::perms(0555));
  const bool root = ::geteuid() == 0;  // root may write everywhere
  if (root) {
    ASSERT_EQ(::seteuid(65534), 0);
  }
  const std::string said = refusal(folder_ / "new");
  if (root) {
    ASSERT_EQ(::seteuid(0), 0);
  }
  fs::permissions(folder_, fs::perms::owner_all);
  EXPECT_NE(said.find(folder_.string() + " cannot be written"), std::string::npos) << said;
}

}  // namespace out_folder_test
}  // namespace filum
