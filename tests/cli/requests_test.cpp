#include "cli/requests.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "cli/calibration_plan.h"
#include "cli/camera_plan.h"
#include "cli/dataset_upload.h"
#include "tests/session/synthetic.h"

namespace filum {
namespace requests_test {

std::string nested(int levels) { return std::string(static_cast<std::size_t>(levels), '[') + std::string(static_cast<std::size_t>(levels), ']'); }

TEST(Requests, AnObjectsTextsAreReadOrRefused) {
  EXPECT_EQ(requested_text(R"({"dataset":"block"})", "dataset"), "block");
  EXPECT_EQ(requested_names(R"({"sessions":["a","b"]})", "sessions"), (std::vector<std::string>{"a", "b"}));
  for (const char* body : {"", "[]", "{", R"({"dataset":1})", R"({"other":"block"})"}) EXPECT_THROW(requested_text(body, "dataset"), InputError) << body;
  for (const char* body : {R"({"sessions":"a"})", R"({"sessions":[1]})"}) EXPECT_THROW(requested_names(body, "sessions"), InputError) << body;
}

template <class Read>
std::string found_in(const Read& read) {
  try {
    read();
  } catch (const InputError& error) {
    return error.value;
  }
  return "taken";
}

TEST(Requests, WhatIsOfAnotherTypeIsShown) {
  EXPECT_EQ(found_in([] { requested_text(R"({"dataset":1})", "dataset"); }), "1");
  EXPECT_EQ(found_in([] { requested_text(R"({"other":1})", "dataset"); }), "nothing");
  EXPECT_EQ(found_in([] { requested_text("[1]", "dataset"); }), "nothing");
  EXPECT_EQ(found_in([] { requested_names(R"({"sessions":"a"})", "sessions"); }), "\"a\"");
  const auto scales = parsed_json(R"([{"name":"mars10","most":2,"items":[]}])");
  EXPECT_EQ(found_in([&] { requested_rating("s", "t", scales, R"({"rater":7,"scale":"mars10","marks":{}})"); }), "7");
  EXPECT_EQ(found_in([&] { requested_rating("s", "t", scales, R"({"rater":"R1","scale":"mars10","marks":3})"); }), "3");
  EXPECT_EQ(found_in([&] { requested_rating("s", "t", scales, R"({"rater":"R1","scale":4,"marks":{}})"); }), "4");
  EXPECT_EQ(found_in([&] { requested_rating("s", "t", scales, R"({"rater":"R1","marks":{}})"); }), "nothing");
  EXPECT_EQ(found_in([&] { requested_rating("s", "t", scales, R"({"rater":"R1","scale":"lapse-index","marks":{}})"); }), "\"lapse-index\"");
  EXPECT_EQ(found_in([&] { requested_rating("s", "t", 5, R"({"rater":"R1","scale":"mars10","marks":{}})"); }), "5") << "a damaged recording's";
}

TEST(Requests, MarksAreThoseOfTheScaleThatIsNamed) {
  const auto scales = parsed_json(R"([{"name":"mars10","most":2,"items":[{"name":"knots"}]},{"name":"lapse-index","most":1,"items":[{"name":"oblique"}]}])");
  const Rating rating = requested_rating("s", "t", scales, R"({"rater":"R1","scale":"lapse-index","marks":{"oblique":1}})");
  EXPECT_EQ(rating.scale, "lapse-index");
  ASSERT_EQ(rating.marks.size(), 1u);
  EXPECT_EQ(rating.marks[0].item, "oblique");
  EXPECT_EQ(found_in([&] { requested_rating("s", "t", scales, R"({"rater":"R1","scale":"lapse-index","marks":{"oblique":2}})"); }), "2") << "a lapse is there or not";
  EXPECT_EQ(found_in([&] { requested_rating("s", "t", scales, R"({"rater":"R1","scale":"mars10","marks":{"oblique":1}})"); }), "nothing");
}

TEST(Requests, AResultOfAnEarlierProgramHasItsOneScale) {
  EXPECT_EQ(scales_of(parsed_json(R"({"scale":{"name":"a"}})")), parsed_json(R"([{"name":"a"}])"));
  EXPECT_EQ(scales_of(parsed_json(R"({"scales":[{"name":"a"},{"name":"b"}]})")).size(), 2u);
  EXPECT_TRUE(scales_of(parsed_json("{}")).empty());
  EXPECT_TRUE(scales_of(parsed_json("[]")).empty());
}

TEST(Requests, JsonDeeperThanTheLimitIsNone) {
  EXPECT_TRUE(parsed_json(nested(kJsonDepth)).is_array());
  EXPECT_TRUE(parsed_json(nested(kJsonDepth + 1)).is_discarded());
  EXPECT_TRUE(parsed_json("{").is_discarded());
}

/// Copying or printing it would run out of the stack. A body of 64 kB took half of it; a recording's result may be of any length.
TEST(Requests, NestingThatWouldEndTheStackIsRefused) {
  const synthetic::Folder folder;
  DatasetUpload upload(folder.file("datasets"));
  const std::string deep = nested(300000);
  EXPECT_THROW(requested_names(R"({"sessions":[)" + deep + "]}", "sessions"), InputError);
  EXPECT_THROW(calibration_plan(R"({"sensor":)" + deep + "}", "", "", ""), InputError);
  EXPECT_THROW(camera_plan(R"({"name":)" + deep + "}", "program", "", ""), InputError);
  EXPECT_THROW(upload.begin(R"({"dataset":"d","files":[{"name":"a","bytes":)" + deep + "}]}"), InputError);
  const auto scales = parsed_json(R"([{"name":"mars10","most":2,"items":[]}])");
  EXPECT_THROW(requested_rating("s", "t", scales, R"({"rater":"R1","scale":"mars10","marks":)" + deep + "}"), InputError);
}

/// A damaged recording's scale: a number that no int holds is not turned into one.
TEST(Requests, AScaleOfAbsurdPointsIsRefused) {
  const auto rated = [](const char* most) {
    const auto scales = parsed_json(std::string(R"([{"name":"mars10","most":)") + most + R"(,"items":[{"name":"closure"}]}])");
    return requested_rating("s", "t", scales, R"({"rater":"R1","scale":"mars10","marks":{"closure":1}})");
  };
  EXPECT_EQ(rated("2").marks.front().points, 1);
  for (const char* most : {"22222222222222222222222222222222", "4294967298", "1.5", "-1", "\"2\"", "null"}) EXPECT_THROW(rated(most), InputError) << most;
}

}  // namespace requests_test
}  // namespace filum
