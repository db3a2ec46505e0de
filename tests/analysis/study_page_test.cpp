// Files of a study whose numbers are known: what stands in which column, and that nobody's text breaks out of its cell.
#include "analysis/study_page.h"

#include <gtest/gtest.h>

#include <limits>
#include <sstream>

namespace filum {
namespace study_page_test {

StudySession session(const std::string& id, const std::string& code, double k) {
  StudySession s;
  s.id = id;
  s.task = "tip-hold";
  s.participant = code;
  s.started_utc = "2026-11-21T09:30:00Z";
  s.input = "haptic 18930";
  s.recorded_with = "filum 0";
  s.seconds = 12.0;
  s.parts = {{0.1 * k, 1e-4 * k, 2e-5 * k}, {0.12 * k, 1.5e-4 * k, 2.2e-5 * k}};
  s.mean = {0.11 * k, 1.25e-4 * k, 2.1e-5 * k};
  s.force_source = "device";
  s.floor = 1e-6;
  s.floor_source = "clamped tool: still.rec";
  return s;
}

std::vector<std::vector<std::string>> cells(const std::string& csv) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream lines(csv);
  for (std::string line; std::getline(lines, line);) {
    rows.emplace_back(1);
    bool quoted = false;
    for (std::size_t i = 0; i < line.size(); ++i) {
      if (line[i] == '"' && quoted && i + 1 < line.size() && line[i + 1] == '"') rows.back().back() += line[i++];
      else if (line[i] == '"') quoted = !quoted;
      else if (line[i] == ',' && !quoted) rows.back().emplace_back();
      else rows.back().back() += line[i];
    }
  }
  return rows;
}

std::string under(const std::vector<std::vector<std::string>>& rows, std::size_t row, const std::string& head) {
  for (std::size_t k = 0; k < rows[0].size(); ++k)
    if (rows[0][k] == head) return rows.at(row).at(k);
  return "no column " + head;
}

TEST(StudyPage, SessionsAndPartsStandInTheirColumns) {
  const Study study = study_of({session("a", "P1", 1.0), session("b", "P2", 2.0)}, "filum 1");
  const auto sessions = cells(sessions_csv(study)), parts = cells(parts_csv(study));
  ASSERT_EQ(sessions.size(), 3u);
  ASSERT_EQ(parts.size(), 5u);
  for (const auto& rows : {sessions, parts})
    for (const auto& row : rows) EXPECT_EQ(row.size(), rows[0].size());
  EXPECT_EQ(under(sessions, 2, "session"), "b");
  EXPECT_EQ(under(sessions, 2, "force_n"), "0.22");
  EXPECT_EQ(under(sessions, 2, "noise_floor_m"), "1e-06");
  EXPECT_EQ(under(sessions, 2, "derived_with"), "filum 1");
  EXPECT_EQ(under(parts, 4, "part"), "2");
  EXPECT_EQ(under(parts, 4, "accuracy_m"), "0.0003");
}

TEST(StudyPage, WhatWasNotMeasuredIsEmptyAndSaysWhy) {
  StudySession s = session("a", "P1", 1.0);
  s.mean.tremor = std::numeric_limits<double>::quiet_NaN();
  s.tremor_why = "does not stand out";
  const Study study = study_of({s}, "filum 1");
  const auto rows = cells(sessions_csv(study));
  EXPECT_EQ(under(rows, 1, "tremor_m"), "");
  EXPECT_EQ(under(rows, 1, "tremor_why"), "does not stand out");
  const std::string page = study_page(study);
  EXPECT_NE(page.find("not resolved: does not stand out"), std::string::npos);
  EXPECT_EQ(page.find("nan"), std::string::npos);
}

TEST(StudyPage, TextStaysText) {
  StudySession s = session("a\"b,c", "P1", 1.0);
  s.input = "<script>alert(1)</script>";
  const Study study = study_of({s}, "filum \"1\", <b>");
  const auto rows = cells(sessions_csv(study));
  EXPECT_EQ(under(rows, 1, "session"), "a\"b,c");
  EXPECT_EQ(under(rows, 1, "input"), "<script>alert(1)</script>");
  const std::string page = study_page(study);
  EXPECT_EQ(page.find("<script>"), std::string::npos);
  EXPECT_NE(page.find("&lt;script&gt;"), std::string::npos);
  EXPECT_EQ(page.find("<b>"), std::string::npos);
}

TEST(StudyPage, OpensWithoutANetworkAndCountsPeople) {
  const std::string page = study_page(study_of({session("a", "P1", 1.0), session("b", "P1", 2.0), session("c", "P2", 3.0)}, "filum 1"));
  EXPECT_NE(page.find("3 sessions, 2 people"), std::string::npos);
  EXPECT_NE(page.find("<svg"), std::string::npos);
  for (const char* outside : {"src=", "href=", "@import", "url(h", "url(/"}) EXPECT_EQ(page.find(outside), std::string::npos) << outside;
  EXPECT_EQ(study_plot(study_of({session("a", "P1", 1.0)}, "filum 1"), "trace"), "") << "a task that is not in the study";
}

}  // namespace study_page_test
}  // namespace filum
