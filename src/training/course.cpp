#include "training/course.h"

#include <algorithm>
#include <set>

namespace filum {

std::vector<Chapter> load_course(const std::string& path) { return parse_course(YamlNode::load(path)); }

std::vector<Chapter> parse_course(const YamlNode& file) {
  if (file.text("format") != "filum-course/1") file.refuse("format", "filum-course/1");
  std::vector<Chapter> course;
  std::set<std::string> seen;
  for (const YamlNode& node : file.items("chapters")) {
    Chapter chapter{node.text("title"), node.texts("tasks")};
    for (const std::string& task : chapter.tasks)
      if (!seen.insert(task).second) node.refuse("tasks", "each task once in the course, not twice " + task);
    course.push_back(std::move(chapter));
  }
  file.finish();
  return course;
}

std::vector<Chapter> chapters_of(const std::vector<Chapter>& course, const std::vector<std::string>& tasks) {
  std::vector<Chapter> there;
  std::set<std::string> left(tasks.begin(), tasks.end());
  for (const Chapter& chapter : course) {
    Chapter found{chapter.title, {}};
    for (const std::string& task : chapter.tasks)
      if (left.erase(task) > 0) found.tasks.push_back(task);
    if (!found.tasks.empty()) there.push_back(std::move(found));
  }
  if (!left.empty()) there.push_back({there.empty() ? "Tasks" : "Other tasks", {left.begin(), left.end()}});
  return there;
}

}  // namespace filum
