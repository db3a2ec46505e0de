// filum validate: the keys of the contract, and that "passed" is what error and tolerance say; the problems are tested in tests/evidence.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "program_call.h"

namespace filum {
namespace validate_test {

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

/// Cells of a row of a Markdown table.
std::vector<std::string> cells_of(const std::string& row) {
  std::vector<std::string> cells;
  std::istringstream rest(row.substr(2));
  for (std::string cell; std::getline(rest, cell, '|');) cells.push_back(cell.substr(0, cell.find_last_not_of(' ') + 1));
  for (std::string& cell : cells) cell.erase(0, cell.find_first_not_of(' '));
  return cells;
}

TEST(Validate, MarkdownIsATableOfTheSameFigures) {
  const auto problems = call({"validate", "--json", "bending-energy", "track-friction"}).json()["problems"];
  const Call table = call({"validate", "--markdown", "bending-energy", "track-friction"});
  EXPECT_EQ(table.code, kDone);
  std::istringstream lines(table.out);
  std::string row;
  std::getline(lines, row);
  EXPECT_EQ(cells_of(row), (std::vector<std::string>{"problem", "source", "expected", "got", "error", "tolerance"}));
  std::getline(lines, row);
  EXPECT_EQ(row, "|---|---|---|---|---|---|");
  for (const auto& p : problems) {
    ASSERT_TRUE(std::getline(lines, row)) << p;
    const auto cells = cells_of(row);
    ASSERT_EQ(cells.size(), 6u) << row;
    EXPECT_EQ(cells[0], p["name"].get<std::string>() + ": " + p["quantity"].get<std::string>());
    EXPECT_EQ(cells[1], p["source"].get<std::string>());
    const double expected = p["expected"], got = p["got"], error = p["error"];
    EXPECT_NEAR(std::stod(cells[2]), expected, 1e-5 * std::abs(expected)) << row;
    EXPECT_NEAR(std::stod(cells[3]), got, 1e-5 * std::abs(got)) << row;
    EXPECT_NEAR(std::stod(cells[4]), error, 0.05 * error) << row;
    EXPECT_DOUBLE_EQ(std::stod(cells[5]), p["tolerance"].get<double>()) << row;
  }
  EXPECT_FALSE(std::getline(lines, row)) << row;
}

TEST(Validate, OneFormOfOutputIsAskedFor) { expect_refused({"validate", "--json", "--markdown", "track-friction"}, {"--markdown", "--json"}); }

TEST(Validate, AProblemThatDoesNotExistIsRefused) { expect_refused({"validate", "--json", "squaring-the-circle"}, {"found squaring-the-circle", "expected", "linking-number"}); }

}  // namespace validate_test
}  // namespace filum
