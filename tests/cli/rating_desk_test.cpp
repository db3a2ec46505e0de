#include "cli/rating_desk.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/session/synthetic.h"

namespace filum {
namespace rating_desk_test {

using nlohmann::json;

const std::string kMars = R"({"name":"mars10","title":"MARS10","source":"S","label":"L","most":2,"items":[
  {"name":"closure","title":"Closure","points":["a","b","c"],"estimate":1,"value":10,"unit":"ml/min","why":"leak"},
  {"name":"knots","title":"Knots","points":["a","b","c"],"estimate":null,"value":null,"unit":"-","why":"left to the rater"}]})";
const std::string kEarlier = R"({"task":"anastomosis-8","title":"Join","scale":)" + kMars + "}";
const std::string kResult = R"({"task":"anastomosis-8","title":"Join","scales":[)" + kMars + R"(,
  {"name":"lapse-index","title":"Lapses","source":"S","label":"L","most":1,"better":"fewer","items":[
  {"name":"oblique","title":"Oblique","points":["no","yes"],"estimate":1,"value":2,"unit":"-","why":"two"},
  {"name":"back-wall","title":"Back wall","points":["no","yes"],"estimate":0,"value":0,"unit":"-","why":"none"}]}]})";

RatingDesk desk_in(const synthetic::Folder& folder) {
  return RatingDesk(folder.file(""), [](const std::string& id) -> std::optional<std::string> {
    if (id == "s1" || id == "s2") return kResult;
    if (id == "old") return kEarlier;
    if (id == "knot") return R"({"task":"knot-square","title":"Knot"})";
    return std::nullopt;
  });
}

TEST(RatingDesk, StoresTheRatersMarksAndTheEstimatesBesideThem) {
  const synthetic::Folder folder;
  RatingDesk desk = desk_in(folder);
  const json before = json::parse(*desk.get("/api/ratings/s1"));
  ASSERT_EQ(before["scales"].size(), 2u);
  EXPECT_EQ(before["scales"][0]["items"].size(), 2u);
  EXPECT_TRUE(before["ratings"].empty());
  const json after = json::parse(*desk.post("/api/ratings/s1", R"({"rater":"R1","scale":"mars10","marks":{"closure":2,"knots":1}})"));
  ASSERT_EQ(after["ratings"].size(), 2u);
  EXPECT_EQ(after["ratings"][0]["rater"], "R1");
  EXPECT_EQ(after["ratings"][1]["rater"], "simulator");
  EXPECT_EQ(after["ratings"][1]["marks"], json({{"closure", 1}}));
  desk.post("/api/ratings/s2", R"({"rater":"R1","scale":"mars10","marks":{"closure":1,"knots":0}})");
  const json agreement = json::parse(*desk.get("/api/agreement"));
  ASSERT_EQ(agreement["agreement"].size(), 1u);
  EXPECT_EQ(agreement["agreement"][0]["b"], "simulator");
  EXPECT_EQ(agreement["agreement"][0]["sessions"], 2);
  EXPECT_EQ(agreement["agreement"][0]["same"], 0.5);
  const auto csv = desk.document("/documents/agreement/ratings.csv");
  ASSERT_TRUE(csv.has_value());
  EXPECT_NE(csv->text.find("s2,anastomosis-8,mars10,R1,"), std::string::npos);
  EXPECT_TRUE(desk.document("/documents/agreement/agreement.csv").has_value());
  EXPECT_FALSE(desk.document("/documents/agreement/../index.sqlite").has_value());
}

/// Each with the estimates beside the first marks by it, so that one scale does not wait for the other.
TEST(RatingDesk, EachScaleIsMarkedByItself) {
  const synthetic::Folder folder;
  RatingDesk desk = desk_in(folder);
  const auto given = [](const json& answer) {
    std::vector<std::string> all;
    for (const auto& one : answer["ratings"]) all.push_back(one["scale"].get<std::string>() + " " + one["rater"].get<std::string>());
    return all;
  };
  using Names = std::vector<std::string>;
  EXPECT_EQ(given(json::parse(*desk.post("/api/ratings/s1", R"({"rater":"R1","scale":"mars10","marks":{"closure":2,"knots":1}})"))), (Names{"mars10 R1", "mars10 simulator"}));
  const json both = json::parse(*desk.post("/api/ratings/s1", R"({"rater":"R2","scale":"lapse-index","marks":{"oblique":0,"back-wall":1}})"));
  EXPECT_EQ(given(both), (Names{"lapse-index R2", "lapse-index simulator", "mars10 R1", "mars10 simulator"}));
  EXPECT_EQ(both["ratings"][1]["marks"], json({{"oblique", 1}, {"back-wall", 0}}));
  desk.post("/api/ratings/s2", R"({"rater":"R2","scale":"lapse-index","marks":{"oblique":1,"back-wall":0}})");
  const json agreement = json::parse(*desk.get("/api/agreement"));
  Names rows;
  for (const auto& row : agreement["agreement"]) rows.push_back(row["scale"].get<std::string>() + " " + row["item"].get<std::string>() + " " + std::to_string(row["sessions"].get<int>()));
  EXPECT_EQ(rows, (Names{"lapse-index back-wall 2", "lapse-index oblique 2", "lapse-index total 2", "mars10 closure 1"}));
}

TEST(RatingDesk, ARecordingOfOneScaleIsRatedAsBefore) {
  const synthetic::Folder folder;
  RatingDesk desk = desk_in(folder);
  const json before = json::parse(*desk.get("/api/ratings/old"));
  ASSERT_EQ(before["scales"].size(), 1u);
  EXPECT_EQ(before["scales"][0]["name"], "mars10");
  const json after = json::parse(*desk.post("/api/ratings/old", R"({"rater":"R1","scale":"mars10","marks":{"closure":2,"knots":1}})"));
  EXPECT_EQ(after["ratings"].size(), 2u);
}

TEST(RatingDesk, RefusesHalfFormsNamesAndOtherSessions) {
  const synthetic::Folder folder;
  RatingDesk desk = desk_in(folder);
  for (const char* body : {"", "[]", R"({"scale":"mars10","marks":{"closure":1,"knots":1}})", R"({"rater":"R1","scale":"mars10","marks":{"closure":1}})", R"({"rater":"R1","scale":"mars10","marks":{"closure":1,"knots":3}})",
                           R"({"rater":"R1","scale":"mars10","marks":{"closure":1,"knots":1.5}})", R"({"rater":"R1","scale":"mars10","marks":{"closure":1,"knots":1,"more":1}})",
                           R"({"rater":"R1","marks":{"closure":1,"knots":1}})", R"({"rater":"R1","scale":"lapse-index","marks":{"closure":1,"knots":1}})",
                           R"({"rater":"R1","scale":"lapse-index","marks":{"oblique":2,"back-wall":0}})", R"({"rater":"R1","scale":"osats","marks":{"closure":1,"knots":1}})",
                           R"({"rater":"Jane Doe","scale":"mars10","marks":{"closure":1,"knots":1}})", R"({"rater":"simulator","scale":"mars10","marks":{"closure":1,"knots":1}})"}) {
    const json answer = json::parse(*desk.post("/api/ratings/s1", body));
    EXPECT_TRUE(answer.contains("refused")) << body;
  }
  EXPECT_TRUE(json::parse(*desk.post("/api/ratings/knot", R"({"rater":"R1","scale":"mars10","marks":{}})")).contains("refused"));
  EXPECT_FALSE(desk.post("/api/ratings/none", R"({"rater":"R1","scale":"mars10","marks":{}})").has_value());
  EXPECT_TRUE(json::parse(*desk.get("/api/ratings/s1"))["ratings"].empty());
  EXPECT_TRUE(json::parse(*desk.get("/api/agreement"))["agreement"].empty());
}

/// What a recording says of its result may be anything: the desk refuses, the trainer goes on.
TEST(RatingDesk, ADamagedResultIsRefused) {
  const synthetic::Folder folder;
  for (const char* result : {"", "[", "[]", R"({"task":5})", R"({"task":"t","scale":5})", R"({"task":"t","scales":5})", R"({"task":"t","scales":[5]})", R"({"task":"t","scale":{"name":"s","most":"two","items":[]}})"}) {
    RatingDesk desk(folder.file(""), [&](const std::string&) -> std::optional<std::string> { return result; });
    EXPECT_TRUE(desk.get("/api/ratings/s1").has_value()) << result;
    EXPECT_TRUE(json::parse(*desk.post("/api/ratings/s1", R"({"rater":"R1","scale":"mars10","marks":{}})")).contains("refused")) << result;
  }
}

}  // namespace rating_desk_test
}  // namespace filum
