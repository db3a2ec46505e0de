#pragma once
// The course: in which chapters and order tasks are offered, from a file (curricula/course.yaml, format filum-course/1).
// Test: course_test.

#include <string>
#include <vector>

#include "base/yaml_file.h"

namespace filum {

struct Chapter {
  std::string title;
  std::vector<std::string> tasks;  // names, in the order in which they are learnt
};

/// Throws InputError; no task stands in it twice.
std::vector<Chapter> load_course(const std::string& path);
std::vector<Chapter> parse_course(const YamlNode& file);

/// The course with the tasks that there are: chapters left empty are left out, tasks without a chapter follow in one of their own.
std::vector<Chapter> chapters_of(const std::vector<Chapter>& course, const std::vector<std::string>& tasks);

}  // namespace filum
