#include "training/knot_diagram.h"

#include <gtest/gtest.h>

#include "tests/training/knot_shapes.h"
#include "training/exact_predicates.h"
#include "training/knot_closure.h"
#include "training/knot_simplify.h"

namespace filum {
namespace knot_diagram_test {

/// A closed curve whose picture from above is a figure of eight with one crossing.
GridPolygon figure_of_eight(double lift) {
  return {Vec3(-1000, -1000, 0), Vec3(1000, 1000, 0), Vec3(1100, -1000, 7), Vec3(-1000, 1100, lift)};
}

TEST(KnotDiagram, SignFollowsTheRightHandRule) {
  // First edge runs to the upper right; the third runs to the upper left. Upper right on top is right-handed.
  const auto below = project(figure_of_eight(-500), Vec3(0, 0, 1));
  ASSERT_TRUE(below.has_value());
  ASSERT_EQ(below->crossings(), 1);
  EXPECT_EQ(below->sign[0], 1);
  EXPECT_TRUE(below->code[0].over);
  EXPECT_FALSE(below->code[1].over);
  const auto above = project(figure_of_eight(500), Vec3(0, 0, 1));
  ASSERT_TRUE(above.has_value());
  EXPECT_EQ(above->sign[0], -1);
  EXPECT_FALSE(above->code[0].over);
}

TEST(KnotDiagram, SignDoesNotDependOnTheSideSeenFrom) {
  const auto front = project(figure_of_eight(-500), Vec3(0, 0, 1));
  const auto back = project(figure_of_eight(-500), Vec3(0, 0, -1));
  ASSERT_TRUE(front && back);
  EXPECT_EQ(front->sign, back->sign);
  EXPECT_NE(front->code[0].over, back->code[0].over);
}

TEST(KnotDiagram, RefusesADegenerateDirection) {
  // Seen along x the first edge and a corner of another lie on one line.
  const GridPolygon square = {Vec3(0, 0, 0), Vec3(1000, 0, 0), Vec3(1000, 0, 1000), Vec3(0, 0, 1000)};
  EXPECT_FALSE(project(square, Vec3(1, 0, 0)).has_value());
  const GridPolygon corner_on_edge = {Vec3(-500, 0, 0), Vec3(500, 0, 0), Vec3(500, 500, 9), Vec3(0, 0, 300),
                                      Vec3(-500, 700, 9)};
  EXPECT_FALSE(project(corner_on_edge, Vec3(0, 0, 1)).has_value());
}

TEST(KnotDiagram, PredicateIsExactWhereDoublesAreNot) {
  // Nearly coplanar at the grid's size: the determinant is 1 beside products of 2^81.
  const double big = 0x1.0p27;
  const Vec3 u(big, big - 1, 0), v(big + 1, big, 0), w(0, 0, 1);
  EXPECT_EQ(sign_det(u, v, w), 1);
  EXPECT_EQ(sign_det(v, u, w), -1);
  EXPECT_EQ(sign_det(u, u, w), 0);
  EXPECT_EQ(sign_det(Vec3(big, big - 1, 5), Vec3(big + 1, big, 5), Vec3(1, 1, 0)), 0);
}

TEST(KnotDiagram, WritheOfAPlanarPictureOfATrefoilIsThree) {
  const Points thread = shapes::open_braid(2, {1, 1, 1});
  const Points closed =
      close_curve(thread, {Vec3(1, 0.1, 0.05).normalized(), Vec3(1, 0.1, -0.05).normalized()});
  GridPolygon polygon = to_grid(closed, 3);
  KnotDiagram diagram = project_best(polygon, 3, 20);
  EXPECT_EQ(diagram.crossings(), 3);
  EXPECT_EQ(std::abs(diagram.writhe()), 3);
  EXPECT_EQ(diagram.code.size(), 6u);
}

}  // namespace knot_diagram_test
}  // namespace filum
