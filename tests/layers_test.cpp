// Includes point only downward. The table is that of src/ARCHITECTURE.md.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <regex>
#include <string>
#include <vector>

namespace layers_test {

namespace fs = std::filesystem;

/// Folder -> what it may include besides itself: a folder, or one header of it.
const std::map<std::string, std::vector<std::string>> kMayUse = {
    {"base", {}},
    {"collision", {"base"}},
    {"devices", {"base", "hardware"}},
    {"tracker", {"base", "devices"}},
    {"anatomy", {"base"}},
    {"physics", {"base", "collision"}},
    {"world", {"base", "collision", "physics"}},
    {"haptics", {"base", "world", "devices"}},
    {"training", {"base", "world/observation.h"}},
    {"session", {"base", "world"}},
    {"server", {"base", "world/observation.h", "training", "session"}},
    {"analysis", {"base", "training", "session"}},
    {"video", {"base"}},
    {"ranks", {}},
    {"reconcile", {"base", "collision", "devices/bridge_line.h", "physics", "video/tracks.h"}},
    {"evidence", {"base", "collision", "physics", "world"}},
    {"cli", {"base", "reconcile", "ranks/ranks.h", "collision", "devices", "physics", "world", "haptics", "training", "session", "server", "analysis", "evidence"}},
};

/// What is wrong with `#include "included"` in a file of `folder`; nothing if it is allowed.
std::optional<std::string> objection(const std::string& folder, const std::string& included) {
  const std::size_t slash = included.find('/');
  if (slash == std::string::npos) return "names no folder; write \"" + folder + "/" + included + "\"";
  const std::string target = included.substr(0, slash);
  if (target == folder) return std::nullopt;
  const auto row = kMayUse.find(folder);
  if (row == kMayUse.end()) return "stands in a folder that has no layer";
  for (const std::string& allowed : row->second)
    if (allowed == target || allowed == included) return std::nullopt;
  return folder + " may not use " + included;
}

/// Includes in quotation marks, one a line, comments left out.
std::vector<std::string> includes_in(std::istream& source) {
  static const std::regex kInclude(R"(^\s*#\s*include\s*"([^"]+)\".*)");
  std::vector<std::string> found;
  std::smatch match;
  for (std::string line; std::getline(source, line);)
    if (std::regex_match(line, match, kInclude)) found.push_back(match[1]);
  return found;
}

struct Tally {
  int files = 0;
  int includes = 0;
  std::vector<std::string> objections;
};

Tally check_tree(const fs::path& src) {
  Tally tally;
  for (const auto& entry : fs::recursive_directory_iterator(src)) {
    const std::string extension = entry.path().extension();
    if (!entry.is_regular_file() || (extension != ".h" && extension != ".cpp")) continue;
    const fs::path relative = entry.path().lexically_relative(src);
    const std::string folder = *relative.begin();
    if (folder == "viewer") continue;  // TypeScript
    ++tally.files;
    std::ifstream stream(entry.path());
    for (const std::string& included : includes_in(stream)) {
      ++tally.includes;
      if (const auto problem = objection(folder, included))
        tally.objections.push_back(relative.generic_string() + ": " + *problem);
    }
  }
  return tally;
}

TEST(Layers, IncludesPointOnlyDownward) {
  const Tally tally = check_tree(fs::path(FILUM_SOURCE_DIR) / "src");
  for (const std::string& problem : tally.objections) ADD_FAILURE() << problem;
  EXPECT_GT(tally.files, 20);  // the tree was found
  EXPECT_GT(tally.includes, 40);
}

TEST(Layers, EveryLayerOfTheTableIsNamedInTheArchitecture) {
  std::ifstream stream(fs::path(FILUM_SOURCE_DIR) / "src/ARCHITECTURE.md");
  const std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  for (const auto& [folder, allowed] : kMayUse)
    EXPECT_TRUE(std::regex_search(text, std::regex("\\b" + folder + "\\b"))) << folder;
}

TEST(Layers, APlantedUpwardIncludeIsFound) {
  std::string name = (fs::temp_directory_path() / "layers-XXXXXX").string();
  ASSERT_NE(::mkdtemp(name.data()), nullptr);
  const fs::path src(name);
  fs::create_directories(src / "world");
  fs::create_directories(src / "server");
  std::ofstream(src / "world/model.cpp") << "#include <vector>\n"
                                            "#include \"physics/rod.h\"\n"
                                            "// #include \"cli/old.h\"\n"
                                            "  #  include \"session/recorder.h\"\n";
  std::ofstream(src / "server/server.cpp") << "#include \"world/observation.h\"\n"
                                              "#include \"world/state.h\"\n"
                                              "#include \"server.h\"\n"
                                              "#include \"devices/device.h\"\n";
  const Tally tally = check_tree(src);
  fs::remove_all(src);
  EXPECT_EQ(tally.includes, 6);
  EXPECT_EQ(tally.objections.size(), 4u);
  const auto said = [&](const std::string& text) {
    for (const std::string& problem : tally.objections)
      if (problem.find(text) != std::string::npos) return true;
    return false;
  };
  EXPECT_TRUE(said("world may not use session/recorder.h"));
  EXPECT_TRUE(said("server may not use world/state.h"));
  EXPECT_TRUE(said("server may not use devices/device.h"));
  EXPECT_TRUE(said("names no folder"));
}

}  // namespace layers_test
