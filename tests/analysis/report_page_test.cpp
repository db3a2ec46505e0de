#include "analysis/report_page.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace filum {
namespace report_page_test {

/// A session made by hand: 40 s of a 9 Hz tone.
RecordedSession session(const std::string& file, const std::string& input) {
  RecordedSession s;
  s.file = file;
  s.meta.task = "tip-hold";
  s.meta.input = input;
  s.seconds = 40.0;
  ToolSeries tool;
  tool.hand.p.resize(3, 20000);
  for (int k = 0; k < 20000; ++k) {
    const double t = 2e-3 * k;
    tool.hand.clock.push_back(t);
    tool.hand.scene.push_back(t);
    tool.hand.p.col(k) = Vec3(50e-6 * std::sin(2.0 * std::numbers::pi * 9.0 * t), 0, 0);
  }
  tool.scene = tool.hand;
  s.tools.push_back(tool);
  return s;
}

TEST(ReportPage, ShowsValuesWithTheirFloorAndRefusalsWithTheirReason) {
  AnalysisInput input;
  input.sessions = {session("a<script>.rec", "demonstrator")};
  std::string page = report_page(analyse(input, "filum 1"));
  EXPECT_NE(page.find("<td>35.4 um</td>"), std::string::npos) << "50 um / sqrt 2 in 8-12 Hz";
  EXPECT_NE(page.find("zero: a script has no sensor"), std::string::npos);
  EXPECT_NE(page.find("<polyline"), std::string::npos);
  EXPECT_NE(page.find("Derived with filum 1"), std::string::npos);
  EXPECT_EQ(page.find("<script>"), std::string::npos);
  EXPECT_EQ(page.find("nan"), std::string::npos);
  input.sessions = {session("b.rec", "serial /dev/ttyACM0"), session("c.rec", "serial /dev/ttyACM0")};
  page = report_page(analyse(input, "filum 1"));
  EXPECT_NE(page.find("Not resolved: noise floor not measured"), std::string::npos);
  EXPECT_EQ(page.find("<td>35.4 um</td>"), std::string::npos) << "nothing is called tremor that is not resolved";
}

}  // namespace report_page_test
}  // namespace filum
