#include "base/file_kind.h"

#include <gtest/gtest.h>

#include <fstream>
#include <string>

namespace filum {
namespace file_kind_test {

TEST(FileKind, FilesAndFoldersAreToldApart) {
  const std::filesystem::path folder = testing::TempDir(), file = folder / "filum_file_kind_test.txt";
  std::ofstream(file) << "a";
  EXPECT_TRUE(is_file(file) && is_there(file) && !is_folder(file));
  EXPECT_TRUE(is_folder(folder) && is_there(folder) && !is_file(folder));
  std::filesystem::remove(file);
}

TEST(FileKind, WhatTheSystemRefusesIsNotThere) {
  for (const std::filesystem::path& path : {std::filesystem::path(std::string(300, 'a')), std::filesystem::path("a.txt") / "b", std::filesystem::path()})
    EXPECT_FALSE(is_file(path) || is_folder(path) || is_there(path)) << path;
}

}  // namespace file_kind_test
}  // namespace filum
