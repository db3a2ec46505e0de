// filum list: names are those of the folders, whatever order the file system gives them in.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <set>

#include "base/error.h"
#include "cli/setup.h"
#include "program_call.h"
#include "tests/session/synthetic.h"

namespace filum {
namespace list_test {

namespace fs = std::filesystem;

std::set<std::string> names_of(const nlohmann::ordered_json& list) {
  std::set<std::string> names;
  for (const auto& one : list) names.insert(one.is_object() ? one["name"].get<std::string>() : one.get<std::string>());
  return names;
}

TEST(List, EveryTaskOnDiskIsListedOnceWithItsTitle) {
  const auto d = call({"list", "--json"}).json();
  expect_keys(d, {"tasks", "models", "curricula", "rigs", "effects"});
  std::set<std::string> on_disk;
  for (const auto& at : fs::recursive_directory_iterator(fs::path(FILUM_SOURCE_DIR) / "curricula"))
    if (at.path().filename() == "task.yaml") on_disk.insert(at.path().parent_path().filename());
  EXPECT_EQ(names_of(d["tasks"]), on_disk);
  EXPECT_EQ(d["tasks"].size(), on_disk.size());
  std::set<std::string> shown_only;
  for (const auto& task : d["tasks"]) {
    EXPECT_FALSE(task["title"].get<std::string>().empty()) << task["name"];
    if (task["demonstration_only"].get<bool>()) shown_only.insert(task["name"].get<std::string>());
  }
  EXPECT_EQ(shown_only, (std::set<std::string>{"knot-granny", "anastomosis-lapses"}));
  EXPECT_TRUE(names_of(d["curricula"]).count("research"));
  EXPECT_EQ(names_of(d["rigs"]), (std::set<std::string>{"tissue-block", "spatula-press", "vessel-inflation", "suture-cantilever", "suture-pull", "needle-insertion", "forceps-bridge", "tip-hold"}));
  for (const char* effect : {"viscoelastic-relaxation", "mains-hum", "elastic_rod", "needle_track", "vessel_wall", "wall_meeting", "vessel_leak", "vessel_flow", "pellet"}) EXPECT_TRUE(names_of(d["effects"]).count(effect)) << effect;
  for (const std::string& effect : names_of(d["effects"]))
    if (effect.find('_') != std::string::npos) { EXPECT_TRUE(fs::exists(fs::path(FILUM_SOURCE_DIR) / "src/physics" / (effect + ".h"))) << effect; }
  for (const auto& model : d["models"]) EXPECT_TRUE(fs::exists(fs::path(FILUM_SOURCE_DIR) / "models" / (model.get<std::string>() + ".yaml"))) << model;
}

/// With it `--input demo` runs, without it is refused.
TEST(List, SaysWhichTasksHaveADemonstration) {
  std::set<std::string> on_disk, listed;
  for (const auto& at : fs::recursive_directory_iterator(fs::path(FILUM_SOURCE_DIR) / "curricula"))
    if (at.path().filename() == "demonstration.yaml") on_disk.insert(at.path().parent_path().filename());
  const auto list = call({"list", "--json"}).json();
  for (const auto& task : list["tasks"])
    if (task["demonstration"].get<bool>()) listed.insert(task["name"].get<std::string>());
  EXPECT_EQ(listed, on_disk);
  EXPECT_TRUE(listed.count("tip-hold")) << "in a folder of a curriculum";
  EXPECT_FALSE(listed.count("end-to-side"));
  EXPECT_FALSE(listed.count("ten-stitches"));
}

/// What the list offers for --model is taken by a task; what it does not is refused.
TEST(List, SaysWhichModelsATaskTakes) {
  const auto d = call({"list", "--json"}).json();
  ASSERT_EQ(d["model_details"].size(), d["models"].size());
  int sutures = 0, baselines = 0;
  for (const auto& model : d["model_details"]) {
    const std::string name = model["name"], file = std::string(FILUM_SOURCE_DIR) + "/models/" + name + ".yaml", kind = model["kind"];
    EXPECT_FALSE(kind.empty()) << name;
    EXPECT_EQ(model["for_tasks"].get<bool>(), kind == "suture" || kind == "brain" || kind == "vessel") << name;
    sutures += kind == "suture";
    baselines += kind == "baseline";
    const auto loads = [&](const char* task) {
      try {
        load_setup(FILUM_SOURCE_DIR, task, file);
        return true;
      } catch (const InputError&) {
        return false;
      }
    };
    EXPECT_EQ(loads("knot-square"), kind == "suture") << name;
    if (kind != "suture") { EXPECT_EQ(loads("press-to-target"), kind == "brain") << name; }
  }
  EXPECT_EQ(sutures, 6);
  EXPECT_EQ(baselines, 7);
  EXPECT_NE(call({"list"}).out.find("suture/capstan                 baseline"), std::string::npos);
}

TEST(List, TextNamesTheSameTasks) {
  const Call text = call({"list"});
  EXPECT_EQ(text.code, kDone);
  for (const auto& name : names_of(call({"list", "--json"}).json()["tasks"])) EXPECT_NE(text.out.find("\n  " + name + " "), std::string::npos) << name;
}

TEST(List, AFolderThatHoldsNothingOfFilumIsRefused) {
  expect_refused({"list", "--root", "/nowhere"}, {"--root", "/nowhere", "a folder with models/ and curricula/"});
}

TEST(List, ATaskThatCannotBeReadIsNamedAndTheOthersAreStillListed) {
  const synthetic::Folder root;
  for (const char* folder : {"models", "curricula"}) fs::copy(fs::path(FILUM_SOURCE_DIR) / folder, root.path() / folder, fs::copy_options::recursive);
  const std::string spoilt = root.file("curricula/knot-square/task.yaml");
  std::ofstream(spoilt) << "format: filum-task/1\ntitle: 3\nknot: fancy\n";
  const Call c = call({"list", "--json", "--root", root.file("")});
  EXPECT_EQ(c.code, kBadInput);
  EXPECT_NE(c.err.find("knot-square/task.yaml"), std::string::npos) << c.err;
  const auto names = names_of(nlohmann::ordered_json::parse(c.out)["tasks"]);
  EXPECT_FALSE(names.count("knot-square"));
  EXPECT_TRUE(names.count("knot-granny"));
}

}  // namespace list_test
}  // namespace filum
