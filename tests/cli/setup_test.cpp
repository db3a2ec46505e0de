#include "cli/setup.h"

#include <gtest/gtest.h>

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>

#include "base/error.h"
#include "training/needle_task.h"
#include "training/rating_scale.h"
#include "world/model.h"
#include "world/vessel_model.h"

namespace filum {
namespace setup_test {

bool holds(const std::vector<std::string>& list, const std::string& one) { return std::find(list.begin(), list.end(), one) != list.end(); }

TEST(Setup, ATaskIsItsSceneAndItsRules) {
  const auto s = load_setup(FILUM_SOURCE_DIR, "knot-square");
  EXPECT_EQ(s.task.name, "knot-square");
  EXPECT_TRUE(s.task.has_knot());
  EXPECT_TRUE(s.model->description.has_post);
  EXPECT_TRUE(s.model_file.empty());
}

TEST(Setup, AnUnknownTaskIsAnsweredWithThoseThereAre) {
  try {
    load_setup(FILUM_SOURCE_DIR, "knot-sqare");
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_EQ(error.value, "knot-sqare");
    EXPECT_NE(error.expected.find("knot-square"), std::string::npos);
  }
}

/// What is said of a copy of a task whose scene has other lines where it had these.
std::string refused(const std::string& task, const std::map<std::string, std::string>& instead) {
  namespace fs = std::filesystem;
  const fs::path root = fs::temp_directory_path() / ("filum-setup-" + std::to_string(getpid()));
  fs::create_directories(root / "curricula");
  fs::create_directory_symlink(fs::path(FILUM_SOURCE_DIR) / "models", root / "models");
  for (const char* shared : {"lapses", "scales"}) fs::create_directory_symlink(fs::path(FILUM_SOURCE_DIR) / "curricula" / shared, root / "curricula" / shared);
  fs::copy(fs::path(FILUM_SOURCE_DIR) / "curricula" / task, root / "curricula" / task);
  const std::string scene = (root / "curricula" / task / "scene.yaml").string();
  std::ifstream in(scene);
  std::string kept;
  for (std::string line; std::getline(in, line);) {
    for (const auto& [had, has] : instead)
      if (line.find(had) != std::string::npos) line = has;
    kept += line + "\n";
  }
  std::ofstream(scene) << kept;
  std::string said;
  try {
    load_setup(root.string(), task);
  } catch (const InputError& error) {
    said = error.what();
  }
  fs::remove_all(root);
  return said;
}

TEST(Setup, ATaskThatWantsAToolWhichItsSceneLacksIsRefused) {
  EXPECT_NE(refused("knot-square", {{"name: scissors", ""}}).find("scissors among the instruments"), std::string::npos);
  EXPECT_NE(refused("triangulation-120", {{"name: scissors", ""}}).find("scissors among the instruments"), std::string::npos);
  EXPECT_NE(refused("vessel-stitch", {{"name: needle-holder", ""}}).find("one of the 1 instruments"), std::string::npos);
}

/// Listed tasks were there whose steps could not be made.
TEST(Setup, WhatHasNoAdventitiaCannotBeHeldByIt) {
  EXPECT_NE(refused("vessel-handling", {{"preset:", "  preset: silicone-tube"}, {"track:", "  track: silicone"}}).find("adventitia"), std::string::npos);
  EXPECT_EQ(refused("vessel-handling", {{"preset:", "  preset: chicken-artery"}}), "");
}

TEST(Setup, EveryTaskHasTheToolsForItsSteps) {
  for (const std::string& name : task_names(FILUM_SOURCE_DIR)) EXPECT_NO_THROW(load_setup(FILUM_SOURCE_DIR, name)) << name;
}

/// A stitch that counts as too tight where the wall has given way long before would never be told.
TEST(Setup, AWallBearsWhatCountsAsTooTight) {
  int looked_at = 0;
  for (const std::string& name : task_names(FILUM_SOURCE_DIR)) {
    const auto s = load_setup(FILUM_SOURCE_DIR, name);
    if (!s.model->vessel || !s.task.needle) continue;
    ++looked_at;
    EXPECT_LT(s.task.needle->lapses.tight, 0.5 * s.model->vessel->track.tear) << name;
  }
  EXPECT_GT(looked_at, 5);
}

/// A join whose line of stitches is looked at, and the planted lapses: raters and simulator are compared lapse by lapse.
TEST(Setup, EveryJoinIsRatedByMarsAndByTheLapseIndex) {
  int joins = 0;
  for (const std::string& name : task_names(FILUM_SOURCE_DIR)) {
    const auto s = load_setup(FILUM_SOURCE_DIR, name);
    if (!s.task.needle || (!std::isfinite(s.task.needle->lapses.line_gap) && name != "anastomosis-lapses")) continue;
    ++joins;
    ASSERT_EQ(s.task.needle->scales.size(), 2u) << name;
    EXPECT_EQ(s.task.needle->scales[0]->name.substr(0, 6), "mars10") << name;
    EXPECT_EQ(s.task.needle->scales[1]->name, "lapse-index") << name;
  }
  EXPECT_EQ(joins, 9);
}

TEST(Setup, EveryTaskThatIsListedCanBeRead) {
  std::vector<std::string> problems;
  const auto tasks = load_tasks(FILUM_SOURCE_DIR, problems);
  EXPECT_TRUE(problems.empty());
  const auto names = task_names(FILUM_SOURCE_DIR);
  EXPECT_EQ(tasks.size(), names.size());
  EXPECT_TRUE(std::is_sorted(names.begin(), names.end()));
  EXPECT_TRUE(holds(names, "tip-hold"));
  EXPECT_EQ(tasks.front().name, "knot-throw") << "in the order of the course";
  for (const Chapter& chapter : load_chapters(FILUM_SOURCE_DIR, problems)) EXPECT_NE(chapter.title, "Other tasks") << chapter.tasks.front();
  std::size_t named = 0;
  for (const Chapter& chapter : load_course(FILUM_SOURCE_DIR "/curricula/course.yaml")) named += chapter.tasks.size();
  EXPECT_EQ(named, names.size()) << "the course names a task that is not there";
}

TEST(Setup, AModelIsAFileOrANameOfTheList) {
  const std::string root = FILUM_SOURCE_DIR, file = root + "/models/vessel/chicken-artery.yaml";
  const auto by_name = load_setup(root, "artery-stitch", "vessel/chicken-artery"), by_file = load_setup(root, "artery-stitch", file);
  EXPECT_EQ(by_name.model_file, file);
  EXPECT_EQ(by_name.model->vessel->name, by_file.model->vessel->name);
  EXPECT_THROW(load_setup(root, "artery-stitch", "vessel/no-artery"), InputError);
}

TEST(Setup, ModelsAreNamedByFolderAndFile) {
  EXPECT_TRUE(holds(model_names(FILUM_SOURCE_DIR), "suture/10-0-nylon"));
  EXPECT_TRUE(std::filesystem::exists(demonstration_file(FILUM_SOURCE_DIR, "knot-square")));
}

}  // namespace setup_test
}  // namespace filum
