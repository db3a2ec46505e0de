#include "cli/camera_plan.h"

#include <gtest/gtest.h>

#include "tests/refusal.h"

namespace filum {
namespace camera_plan_test {

CameraPlan taken(const std::string& wish, const std::string& fixed = "") { return camera_plan(wish, "filum_camera", "folder", fixed); }

/// What is said of a wish; an empty field if it is taken.
InputError refusal(const std::string& wish, const std::string& fixed = "") { return refusal_by([&] { taken(wish, fixed); }); }

std::string with(const std::string& key, const std::string& value) { return "{\"" + key + "\":" + value + "}"; }

void expect_refused(const std::string& key, const std::string& value, const std::string& expected) {
  const InputError error = refusal(with(key, value));
  EXPECT_EQ(error.file, "camera") << value;
  EXPECT_EQ(error.field, key) << value;
  EXPECT_EQ(error.value, value);
  EXPECT_EQ(error.expected, expected) << value;
}

TEST(CameraPlan, WhatIsAbsentKeepsItsDefault) {
  const CameraPlan plan = taken("{}");
  EXPECT_EQ(plan.program, "filum_camera");
  EXPECT_EQ(plan.folder, "folder");
  EXPECT_EQ(plan.source, "0");
  EXPECT_EQ(plan.name, "camera");
  EXPECT_EQ(plan.square, 10.0) << "mm";
}

TEST(CameraPlan, WhatIsWishedIsTaken) {
  const CameraPlan plan = taken(R"({"source":2,"square":7.5,"name":"over the bench_1.b"})");
  EXPECT_EQ(plan.source, "2");
  EXPECT_EQ(plan.square, 7.5);
  EXPECT_EQ(plan.name, "over the bench_1.b");
}

TEST(CameraPlan, ProgramAndFolderAreNotThePagesToChoose) {
  const CameraPlan plan = taken(R"({"program":"/bin/sh","folder":"/etc"})");
  EXPECT_EQ(plan.program, "filum_camera");
  EXPECT_EQ(plan.folder, "folder");
}

/// A page names cameras only; a video, or what the system makes of a path, is for the command line.
TEST(CameraPlan, ASourceIsTheNumberOfACamera) {
  EXPECT_EQ(taken(with("source", "0")).source, "0");
  EXPECT_EQ(taken(with("source", "99")).source, "99");
  for (const char* bad : {"-1", "100", "1.5", "\"1\"", "\"/etc/passwd\"", "true", "null", "[0]", "18446744073709551615"})
    expect_refused("source", bad, "number of a camera, 0 to 99");
}

TEST(CameraPlan, TheCommandLinesSourceComesFirst) {
  EXPECT_EQ(taken(R"({"source":2})", "video.avi").source, "video.avi");
  EXPECT_EQ(taken("{}", "video.avi").source, "video.avi");
  EXPECT_EQ(refusal(R"({"source":"video.avi"})", "video.avi").field, "source") << "a page's is looked at all the same";
}

TEST(CameraPlan, ASquareIsOneToTwoHundredMillimetres) {
  EXPECT_EQ(taken(with("square", "1")).square, 1.0);
  EXPECT_EQ(taken(with("square", "200")).square, 200.0);
  for (const char* bad : {"0", "0.999", "200.001", "-10", "\"10 mm\"", "null", "[10]"}) expect_refused("square", bad, "1 to 200 mm");
}

TEST(CameraPlan, ANameIsOfAFewPlainLettersAndNoOption) {
  const std::string longest(40, 'a');
  EXPECT_EQ(taken(with("name", "\"" + longest + "\"")).name, longest);
  for (const std::string& bad : {"\"" + longest + "a\"", std::string("7"), std::string("null")}) expect_refused("name", bad, "up to 40 letters");
  for (const char* bad : {"\"\"", "\"--out\"", "\"-\"", "\"../x\"", "\"a\\nb\"", "\"a;b\"", "\"\xc3\xa4\""})
    expect_refused("name", bad, "letters, digits, dots, blanks and dashes");
}

TEST(CameraPlan, WhatIsNoObjectIsShownInPart) {
  for (const char* wish : {"nothing", "[]", "2", "", "{\"source\":2"}) {
    const InputError error = refusal(wish);
    EXPECT_EQ(error.file, "camera") << wish;
    EXPECT_EQ(error.field, "body") << wish;
    EXPECT_EQ(error.value, wish);
    EXPECT_EQ(error.expected, "a JSON object");
  }
  EXPECT_EQ(refusal(std::string(1000, 'x')).value, std::string(80, 'x'));
}

TEST(CameraPlan, WithoutTheCamerasProgramItSaysWhereThatIsBuilt) {
  try {
    camera_plan("nothing", "", "folder", "");
    FAIL() << "taken";
  } catch (const InputError& error) {
    EXPECT_EQ(error.field, "program") << "said before anything is asked of the page";
    EXPECT_NE(error.expected.find("built where OpenCV is"), std::string::npos);
  }
}

}  // namespace camera_plan_test
}  // namespace filum
