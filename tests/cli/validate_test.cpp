// filum validate: the keys of the contract, and that "passed" is what error and tolerance say; the problems are tested in tests/evidence.

#include <gtest/gtest.h>

#include <algorithm>

#include "program_call.h"

namespace filum {
namespace {

TEST(Validate, EveryProblemOfThatNameIsSolvedAndJudged) {
  const auto problems = call({"validate", "--json", "track-friction"}).json()["problems"];
  ASSERT_FALSE(problems.empty());
  for (const auto& p : problems) {
    expect_keys(p, {"name", "source", "quantity", "unit", "expected", "got", "error", "tolerance", "order", "passed", "seconds"});
    EXPECT_EQ(p["name"].get<std::string>().find("track"), 0u);
    EXPECT_TRUE(p["passed"].get<bool>()) << p;
    const double expected = p["expected"], error = std::abs(p["got"].get<double>() - expected) / (expected != 0.0 ? std::abs(expected) : 1.0);
    EXPECT_NEAR(p["error"].get<double>(), error, 1e-9 + 1e-6 * error);
    EXPECT_LE(p["error"].get<double>(), p["tolerance"].get<double>());
    EXPECT_FALSE(p["source"].get<std::string>().empty()) << p;
  }
}

TEST(Validate, TextGivesALineEachAndTheirNumber) {
  const auto n = call({"validate", "--json", "track-friction"}).json()["problems"].size();
  const Call text = call({"validate", "track-friction"});
  EXPECT_EQ(text.code, kDone);
  EXPECT_EQ(static_cast<std::size_t>(std::count(text.out.begin(), text.out.end(), '\n')), n + 2);
  EXPECT_NE(text.out.find(std::to_string(n) + " problems, 0 failed"), std::string::npos) << text.out;
}

TEST(Validate, AProblemThatDoesNotExistIsRefused) { expect_refused({"validate", "--json", "squaring-the-circle"}, {"found squaring-the-circle", "expected", "linking-number"}); }

}  // namespace
}  // namespace filum
