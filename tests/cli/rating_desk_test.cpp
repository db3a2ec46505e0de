#include "cli/rating_desk.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/session/synthetic.h"

namespace filum {
namespace rating_desk_test {

using nlohmann::json;

constexpr const char* kResult = R"({"task":"anastomosis-8","title":"Join","scale":{"name":"mars10","title":"MARS10","source":"S","label":"L","most":2,"items":[
  {"name":"closure","title":"Closure","points":["a","b","c"],"estimate":1,"value":10,"unit":"ml/min","why":"leak"},
  {"name":"knots","title":"Knots","points":["a","b","c"],"estimate":null,"value":null,"unit":"-","why":"left to the rater"}]}})";

RatingDesk desk_in(const synthetic::Folder& folder) {
  return RatingDesk(folder.file(""), [](const std::string& id) -> std::optional<std::string> {
    if (id == "s1" || id == "s2") return kResult;
    if (id == "knot") return R"({"task":"knot-square","title":"Knot"})";
    return std::nullopt;
  });
}

TEST(RatingDesk, StoresTheRatersMarksAndTheEstimatesBesideThem) {
  const synthetic::Folder folder;
  RatingDesk desk = desk_in(folder);
  const json before = json::parse(*desk.get("/api/ratings/s1"));
  EXPECT_EQ(before["scale"]["items"].size(), 2u);
  EXPECT_TRUE(before["ratings"].empty());
  const json after = json::parse(*desk.post("/api/ratings/s1", R"({"rater":"R1","marks":{"closure":2,"knots":1}})"));
  ASSERT_EQ(after["ratings"].size(), 2u);
  EXPECT_EQ(after["ratings"][0]["rater"], "R1");
  EXPECT_EQ(after["ratings"][1]["rater"], "simulator");
  EXPECT_EQ(after["ratings"][1]["marks"], json({{"closure", 1}}));
  desk.post("/api/ratings/s2", R"({"rater":"R1","marks":{"closure":1,"knots":0}})");
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

TEST(RatingDesk, RefusesHalfFormsNamesAndOtherSessions) {
  const synthetic::Folder folder;
  RatingDesk desk = desk_in(folder);
  for (const char* body : {"", "[]", R"({"marks":{"closure":1,"knots":1}})", R"({"rater":"R1","marks":{"closure":1}})", R"({"rater":"R1","marks":{"closure":1,"knots":3}})",
                           R"({"rater":"R1","marks":{"closure":1,"knots":1.5}})", R"({"rater":"R1","marks":{"closure":1,"knots":1,"more":1}})",
                           R"({"rater":"Jane Doe","marks":{"closure":1,"knots":1}})", R"({"rater":"simulator","marks":{"closure":1,"knots":1}})"}) {
    const json answer = json::parse(*desk.post("/api/ratings/s1", body));
    EXPECT_TRUE(answer.contains("refused")) << body;
  }
  EXPECT_TRUE(json::parse(*desk.post("/api/ratings/knot", R"({"rater":"R1","marks":{}})")).contains("refused"));
  EXPECT_FALSE(desk.post("/api/ratings/none", R"({"rater":"R1","marks":{}})").has_value());
  EXPECT_TRUE(json::parse(*desk.get("/api/ratings/s1"))["ratings"].empty());
  EXPECT_TRUE(json::parse(*desk.get("/api/agreement"))["agreement"].empty());
}

/// What a recording says of its result may be anything: the desk refuses, the trainer goes on.
TEST(RatingDesk, ADamagedResultIsRefused) {
  const synthetic::Folder folder;
  for (const char* result : {"", "[", "[]", R"({"task":5})", R"({"task":"t","scale":5})", R"({"task":"t","scale":{"name":"s","most":"two","items":[]}})"}) {
    RatingDesk desk(folder.file(""), [&](const std::string&) -> std::optional<std::string> { return result; });
    EXPECT_TRUE(desk.get("/api/ratings/s1").has_value()) << result;
    EXPECT_TRUE(json::parse(*desk.post("/api/ratings/s1", R"({"rater":"R1","marks":{}})")).contains("refused")) << result;
  }
}

}  // namespace rating_desk_test
}  // namespace filum
