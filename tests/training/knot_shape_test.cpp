#include "training/knot_shape.h"

#include <gtest/gtest.h>

#include "tests/training/knot_shapes.h"
#include "training/knot_invariant.h"

namespace filum {
namespace knot_shape_test {

using namespace shapes;

TEST(KnotShape, CoreIsTheShortestRunWithTheKnot) {
  const Points thread = throws_round_post({3, -3});
  const Laurent square = jones_torus(3) * jones_torus(-3);
  KnotReport report;
  find_core(thread, square, 1, report);
  EXPECT_EQ(jones_of_thread(thread.middleCols(report.core_begin, report.core_end - report.core_begin + 1), 1),
            square);
  const auto shorter = thread.middleCols(report.core_begin + 1, report.core_end - report.core_begin);
  EXPECT_FALSE(jones_of_thread(shorter, 1) == square);
  EXPECT_GT(report.core_begin, 9);  // the tails' ten nodes are no part of it
  EXPECT_LT(report.core_end, static_cast<int>(thread.cols()) - 10);
}

TEST(KnotShape, CoreOfAKnotThatIsNotThereIsEverything) {
  const Points thread = throws_round_post({3});
  KnotReport report;
  find_core(thread, jones_torus(7), 1, report);
  EXPECT_EQ(report.core_begin, 0);
  EXPECT_EQ(report.core_end, static_cast<int>(thread.cols()) - 1);
}

TEST(KnotShape, WindingRoundThePostHasASign) {
  Points thread = throws_round_post({3});
  KnotReport report;
  report.core_begin = 10;
  report.core_end = static_cast<int>(thread.cols()) - 11;
  PostShape bar = post();
  measure_post(thread, bar, report);
  const int winding = report.post_winding;
  EXPECT_EQ(std::abs(winding), 1);
  bar.axis_W = -bar.axis_W;
  measure_post(thread, bar, report);
  EXPECT_EQ(report.post_winding, -winding);
  bar.p_W += Vec3(5e-3, 0, 0);  // beside the thread
  measure_post(thread, bar, report);
  EXPECT_FALSE(report.encloses_post);
  EXPECT_FALSE(report.note.empty());
}

TEST(KnotShape, UnravelsTheOutermostThrowFirst) {
  for (const std::vector<int>& stack :
       {std::vector<int>{-3, 5}, {5, -3}, {3, 3, -3}, {-3, 3, 3}, {5, -3, 3}}) {
    const Points thread = throws_round_post(stack);
    Laurent jones = Laurent::monomial(1, 0);
    for (int t : stack) jones = jones * jones_torus(t);
    KnotReport report;
    find_core(thread, jones, 1, report);
    std::vector<int> members = stack;
    std::reverse(members.begin(), members.end());
    EXPECT_EQ(unravel(thread, members, 1, report), stack);
  }
}

TEST(KnotShape, LooseKnotsAreNotJudged) {
  KnotReport report;
  report.knot_class = "square";
  const Points thread = 20.0 * throws_round_post({3, -3});
  report.core_begin = 0;
  report.core_end = static_cast<int>(thread.cols()) - 1;
  judge_lay(thread, 12e-6, report);
  EXPECT_EQ(report.knot_class, "square");
  EXPECT_NE(report.note.find("loose"), std::string::npos);
}

}  // namespace knot_shape_test
}  // namespace filum
