// filum mesh hands over to the program beside it: every word as it was typed, its exit code, its help; and says what to install where
// that program is not built.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "program_call.h"

namespace filum {
namespace mesh_test {

namespace fs = std::filesystem;

/// Beside this test a program that says how it was called.
class Stub {
 public:
  Stub() {
    std::ofstream(path_) << "#!/bin/bash\nprintf '[%s]' \"$@\" >&2\nexit 42\n";
    fs::permissions(path_, fs::perms::owner_all);
  }
  ~Stub() { fs::remove(path_); }
  static inline const fs::path path_ = fs::read_symlink("/proc/self/exe").parent_path() / "filum_mesh";
};

void hand_over(const std::vector<std::string>& words) {
  std::vector<std::string> all = {"mesh"};
  all.insert(all.end(), words.begin(), words.end());
  std::exit(call(all).code);  // only where it came back
}

// One test, since ctest runs tests side by side and there is one place for the stub.
TEST(Mesh, HandsOverWordForWordAndSaysWhatIsMissing) {
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  fs::remove(Stub::path_);
  const Call without = call({"mesh", "scan.nii", "--out", "region"});
  EXPECT_EQ(without.code, kFailed);
  EXPECT_NE(without.err.find("libcgal-dev"), std::string::npos) << without.err;
  const Stub stub;
  for (const std::vector<std::string>& words : {std::vector<std::string>{"a scan.nii", "--at", "-45,40,45", "--json"}, {"--help"}, {"--no-such-option"}, {"--radius", "30 "}}) {
    std::string said;
    for (const std::string& word : words) said += "\\[" + word + "\\]";
    EXPECT_EXIT(hand_over(words), testing::ExitedWithCode(42), "^" + said + "$") << said;
  }
}

}  // namespace mesh_test
}  // namespace filum
