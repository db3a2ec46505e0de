#include "cli/knot_pull.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "short_session.h"

namespace filum {
namespace knot_pull_test {

namespace fs = std::filesystem;

TEST(KnotPull, StoresTheScoreOfASessionWithoutAKnotAtOnce) {
  std::string folder = (fs::temp_directory_path() / "filum-pull-XXXXXX").string();
  ASSERT_NE(mkdtemp(folder.data()), nullptr);
  const std::string file = folder + "/one.filum-session";
  auto recorder = make_recorder(file, load_setup(FILUM_SOURCE_DIR, "tip-hold"), "demonstrator");
  auto session = started_session(recorder.get());
  const Result ended = session->end().result;
  KnotPull pull(std::move(session), std::move(recorder), "one");
  const Result settled = pull.finish();
  EXPECT_TRUE(pull.over());
  EXPECT_EQ(pull.id(), "one");
  EXPECT_EQ(settled.total, ended.total);
  EXPECT_FALSE(settled.security.has_value());
  ASSERT_NE(pull.recorder(), nullptr);
  EXPECT_TRUE(pull.recorder()->status().healthy);
  ASSERT_TRUE(RecordingReader(file).score().has_value());
  EXPECT_EQ(RecordingReader(file).score()->total, ended.total);
  fs::remove_all(folder);
}

TEST(KnotPull, CanBeLeftBeforeItsEnd) {
  auto session = started_session(nullptr);
  session->end();
  const KnotPull pull(std::move(session), nullptr, "");
  EXPECT_EQ(pull.recorder(), nullptr);
}  // must neither hang nor crash

}  // namespace knot_pull_test
}  // namespace filum
