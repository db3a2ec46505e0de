#include "server/static_files.h"

#include <gtest/gtest.h>

#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace filum {
namespace static_files_test {

namespace fs = std::filesystem;

TEST(RequestPath, StripsQueryAndDecodes) {
  EXPECT_EQ(request_path("/a/b.js?v=1#x"), "/a/b.js");
  EXPECT_EQ(request_path("/a%20b"), "/a b");
  EXPECT_EQ(request_path("/%2e%2e/secret"), "/../secret");
  for (const char* bad : {"", "a", "http://x/", "/%", "/%4", "/%zz", "/%00", "/a\\b", "/\n"}) {
    EXPECT_FALSE(request_path(bad).has_value()) << bad;
  }
}

class StaticFiles : public testing::Test {
 protected:
  void SetUp() override {
    base_ = fs::temp_directory_path() / ("filum-static-" + std::to_string(::getpid()));
    fs::create_directories(base_ / "dist" / "assets");
    fs::create_directories(base_ / "dist-secret");
    write("dist/index.html");
    write("dist/assets/app.js");
    write("secret.txt");
    write("dist-secret/key");
    fs::create_symlink(base_ / "secret.txt", base_ / "dist" / "link");
  }
  void TearDown() override { fs::remove_all(base_); }
  void write(const std::string& name) { std::ofstream(base_ / name) << name; }
  auto find(const std::string& path) { return find_static_file(base_ / "dist", path); }
  fs::path base_;
};

TEST_F(StaticFiles, FindsFilesBelowTheFolder) {
  EXPECT_EQ(find("/"), fs::canonical(base_ / "dist/index.html"));
  EXPECT_EQ(find("/assets/app.js"), fs::canonical(base_ / "dist/assets/app.js"));
  EXPECT_EQ(find("/assets/../index.html"), fs::canonical(base_ / "dist/index.html"));
}

TEST_F(StaticFiles, NothingOutsideTheFolder) {
  for (const char* bad : {"/../secret.txt", "/assets/../../secret.txt", "/../dist-secret/key", "//etc/passwd", "/link", "/assets",
                          "/nothing", "", "index.html"}) {
    EXPECT_FALSE(find(bad).has_value()) << bad;
  }
  EXPECT_FALSE(find_static_file(base_ / "absent", "/").has_value());
}

TEST(MediaType, ByExtension) {
  EXPECT_EQ(media_type("a/index.html"), "text/html; charset=utf-8");
  EXPECT_EQ(media_type("x.js"), "text/javascript; charset=utf-8");
  EXPECT_EQ(media_type("x.unknown"), "application/octet-stream");
}

}  // namespace static_files_test
}  // namespace filum
