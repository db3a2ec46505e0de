// Exports themselves, on a full disk too: export_files_test, export_bids_test.

#include "session/new_files.h"

#include <gtest/gtest.h>

#include <fstream>

#include "base/error.h"
#include "tests/session/synthetic.h"

namespace filum {
namespace new_files_test {

namespace fs = std::filesystem;

void write(const std::string& path, const std::string& text) { std::ofstream(path) << text; }

std::string read(const std::string& path) {
  std::ifstream stream(path);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::size_t entries(const std::string& folder) { return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator())); }

TEST(NewFiles, AreThereAllAtOnceAndReplaceTheSharedOneOnly) {
  const synthetic::Folder folder;
  const std::string out = folder.file("out");
  fs::create_directory(out);
  write(out + "/shared", "old");
  {
    NewFiles files(out, {"a", "b"}, "shared");
    for (const char* name : {"a", "b", "shared"}) write(files.aside(name), std::string("new ") + name);
    EXPECT_FALSE(fs::exists(files.place("a")));
    EXPECT_EQ(read(out + "/shared"), "old") << "until all are whole";
    EXPECT_EQ(files.put(), (std::vector<std::string>{out + "/a", out + "/b", out + "/shared"}));
  }
  EXPECT_EQ(read(out + "/a"), "new a");
  EXPECT_EQ(read(out + "/b"), "new b");
  EXPECT_EQ(read(out + "/shared"), "new shared");
  EXPECT_EQ(entries(out), 3u) << "and nothing aside";
}

/// Folders too, all the way down to the one that was there.
TEST(NewFiles, GivenUpLeaveNothingThatWasNotThere) {
  const synthetic::Folder folder;
  {
    NewFiles files(folder.file("made/on/the/way"), {"a"}, "shared");
    write(files.aside("a"), "half");
  }
  EXPECT_EQ(entries(folder.file("")), 0u);
  fs::create_directory(folder.file("there"));
  { NewFiles files(folder.file("there"), {"a"}, "shared"); }
  EXPECT_TRUE(fs::is_directory(folder.file("there")));
}

TEST(NewFiles, NoneIsWrittenOver) {
  const synthetic::Folder folder;
  write(folder.file("b"), "mine");
  EXPECT_THROW(NewFiles(folder.file(""), {"a", "b"}, "shared"), InputError);
  EXPECT_EQ(entries(folder.file("")), 1u);
  EXPECT_THROW(require_unused(folder.file("b")), InputError);
  EXPECT_NO_THROW(require_unused(folder.file("a")));
  EXPECT_THROW(NewFiles(folder.file("b"), {"a"}, "shared"), InputError) << "a file where the folder should be";
  EXPECT_EQ(read(folder.file("b")), "mine");
}

TEST(NewFiles, TwoExportsToOneFolderDoNotMeetAside) {
  const synthetic::Folder folder;
  NewFiles one(folder.file("out"), {"a"}, "shared"), other(folder.file("out"), {"b"}, "shared");
  EXPECT_NE(one.aside("shared"), other.aside("shared"));
  EXPECT_EQ(one.place("shared"), other.place("shared"));
}

/// A full disk is nobody's bad input.
TEST(NewFiles, ADiskThatFailsIsNoInputError) {
  try {
    throw_unwritten("/somewhere");
  } catch (const InputError&) {
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(std::string(error.what()).find("/somewhere: "), 0u);
  }
}

}  // namespace new_files_test
}  // namespace filum
