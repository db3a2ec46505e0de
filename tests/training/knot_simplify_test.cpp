#include "training/knot_simplify.h"

#include <gtest/gtest.h>

#include "tests/training/knot_shapes.h"
#include "training/knot_closure.h"
#include "training/knot_invariant.h"

namespace filum {
namespace knot_simplify_test {

using namespace shapes;

GridPolygon closed_polygon(const Points& thread, std::uint64_t seed) {
  return to_grid(close_curve(thread, free_closures(thread, 1).front()), seed);
}

TEST(KnotSimplify, ShrinksALooseThreadToATriangle) {
  GridPolygon polygon = closed_polygon(throws_round_post({}), 1);
  shrink(polygon);
  EXPECT_EQ(polygon.size(), 3u);
}

TEST(KnotSimplify, ATrefoilKeepsAtLeastSixEdges) {  // stick number of the trefoil is 6
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    GridPolygon polygon = closed_polygon(throws_round_post({3}), seed);
    shrink(polygon);
    EXPECT_GE(polygon.size(), 6u);
    EXPECT_LE(polygon.size(), 12u);
  }
}

TEST(KnotSimplify, KeepsTheKnotThatTheFullCurveHas) {
  for (const std::vector<int>& stack : {std::vector<int>{3, -3}, {3, 3}, {5, -3}}) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      GridPolygon polygon = closed_polygon(throws_round_post(stack, 60e-6, 3), seed);
      const Laurent before = jones_polynomial(project_best(polygon, seed, 20));
      shrink(polygon);
      EXPECT_EQ(jones_polynomial(project_best(polygon, seed, 5)), before);
      EXPECT_FALSE(before.zero());
    }
  }
}

TEST(KnotSimplify, JitterIsFarBelowTheThread) {
  const Points thread = throws_round_post({3, -3});
  const GridPolygon a = to_grid(thread, 1), b = to_grid(thread, 2);
  const double step =
      (thread.rowwise().maxCoeff() - thread.rowwise().minCoeff()).maxCoeff() / 0x1.0p27;  // [m]
  double moved = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) moved = std::max(moved, (a[k] - b[k]).norm() * step);
  EXPECT_GT(moved, 0.0);
  EXPECT_LT(moved, 1e-9);
}

TEST(KnotSimplify, ReducesLoopsAndOpposedPairsOnly) {
  // Crossing 0 is a loop; 1 and 2 are one strand laid over another (opposite signs); none is left.
  KnotDiagram slack;
  slack.sign = {1, 1, -1};
  slack.code = {{0, true}, {0, false}, {1, true}, {2, true}, {1, false}, {2, false}};
  reduce(slack);
  EXPECT_EQ(slack.crossings(), 0);
  KnotDiagram trefoil;
  trefoil.sign = {1, 1, 1};
  trefoil.code = {{0, true}, {1, false}, {2, true}, {0, false}, {1, true}, {2, false}};
  reduce(trefoil);
  EXPECT_EQ(trefoil.crossings(), 3);
}

TEST(KnotSimplify, HardUnknotsStayHardButHaveTrivialPolynomial) {
  // Morton's braid closes to an unknot that these moves do not undo: its polynomial must tell.
  GridPolygon polygon = closed_polygon(open_braid(4, {-3, -3, 2, -3, 2, 1, 1, 1, -2, 1, -2}), 1);
  const KnotDiagram diagram = project_best(polygon, 1, 30);
  EXPECT_GT(diagram.crossings(), 3);
  EXPECT_EQ(jones_polynomial(diagram), Laurent::monomial(1, 0));
  EXPECT_EQ(alexander_polynomial(diagram), Laurent::monomial(1, 0));
}

}  // namespace knot_simplify_test
}  // namespace filum
