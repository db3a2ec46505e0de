#include "training/course.h"

#include <gtest/gtest.h>

#include "base/error.h"

namespace filum {
namespace course_test {

std::vector<Chapter> parsed(const std::string& text) { return parse_course(YamlNode::parse(text, "course.yaml")); }

const std::string kTwo = "format: filum-course/1\nchapters:\n  - { title: Knots, tasks: [square, granny] }\n  - { title: Needle, tasks: [loading] }\n";

TEST(Course, ChaptersComeInTheOrderOfTheFile) {
  const auto course = parsed(kTwo);
  ASSERT_EQ(course.size(), 2u);
  EXPECT_EQ(course[0].title, "Knots");
  EXPECT_EQ(course[0].tasks, (std::vector<std::string>{"square", "granny"}));
  EXPECT_EQ(course[1].tasks, (std::vector<std::string>{"loading"}));
}

TEST(Course, TasksThatAreNotThereAreLeftOutAndOthersFollow) {
  const auto chapters = chapters_of(parsed(kTwo), {"trace", "granny", "alone"});
  ASSERT_EQ(chapters.size(), 2u);
  EXPECT_EQ(chapters[0].title, "Knots");
  EXPECT_EQ(chapters[0].tasks, (std::vector<std::string>{"granny"}));
  EXPECT_EQ(chapters[1].title, "Other tasks");
  EXPECT_EQ(chapters[1].tasks, (std::vector<std::string>{"alone", "trace"}));
  EXPECT_EQ(chapters_of({}, {"b", "a"}).front().tasks, (std::vector<std::string>{"a", "b"}));
}

TEST(Course, WhatIsWrongIsRefused) {
  EXPECT_THROW(parsed("format: filum-task/1\nchapters: []\n"), InputError);
  EXPECT_THROW(parsed("format: filum-course/1\n"), InputError);
  EXPECT_THROW(parsed("format: filum-course/1\nchapters:\n  - { title: Knots, tasks: [square, square] }\n"), InputError);
  EXPECT_THROW(parsed("format: filum-course/1\nchapters:\n  - { tasks: [square] }\n"), InputError);
  EXPECT_THROW(parsed(kTwo + "order: up\n"), InputError);
}


}  // namespace course_test
}  // namespace filum
