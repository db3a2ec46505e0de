#include "world/brain_section.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace filum {
namespace brain_section_test {

double area_of(const BrainSection& cut, const Points& x) {
  double area = 0.0;
  for (const auto& t : cut.triangles) {
    const Vec3 a = corner_place(cut.corners[static_cast<std::size_t>(t[0])], x), b = corner_place(cut.corners[static_cast<std::size_t>(t[1])], x),
               c = corner_place(cut.corners[static_cast<std::size_t>(t[2])], x);
    area += 0.5 * (b - a).cross(c - a).norm();
  }
  return area;
}

TEST(BrainSection, ACutThroughABlockHasItsFaceEverywhere) {
  const TetMesh mesh = box_mesh(Vec3(-0.02, -0.01, -0.03), Vec3(0.02, 0.01, 0.0), 5, 3, 4);
  for (const double x : {-0.019, -0.0123, 0.0, 0.004, 0.0121}) {  // 0.004: through nodes
    const BrainSection cut = cut_mesh(mesh, x);
    EXPECT_NEAR(area_of(cut, mesh.nodes), 0.02 * 0.03, 1e-12);
    for (const auto& c : cut.corners) {
      EXPECT_LT(std::abs(corner_place(c, mesh.nodes).x() - x), 1.1e-4);
      EXPECT_TRUE(c.t > 0.0 && c.t < 1.0);
    }
    EXPECT_EQ(cut.element.size(), cut.triangles.size());
  }
  EXPECT_TRUE(cut_mesh(mesh, 0.5).triangles.empty());
}

TEST(BrainSection, CornersMoveWithTheTissue) {
  const TetMesh mesh = box_mesh(Vec3::Zero(), Vec3::Ones(), 2, 2, 2);
  const BrainSection cut = cut_mesh(mesh, 0.3);
  Points moved = mesh.nodes;
  moved.row(1) *= 1.5;
  EXPECT_NEAR(area_of(cut, moved), 1.5, 1e-12);
}

TEST(BrainSection, VonMisesIsTheUniaxialStressAndNothingUnderPressure) {
  EXPECT_NEAR(von_mises(Vec3(0, 0, -3.0).asDiagonal()), 3.0, 1e-12);
  EXPECT_NEAR(von_mises(-7.0 * Mat3::Identity()), 0.0, 1e-12);
  Mat3 shear = Mat3::Zero();
  shear(0, 1) = shear(1, 0) = 2.0;
  EXPECT_NEAR(von_mises(shear), 2.0 * std::sqrt(3.0), 1e-12);
}

}  // namespace brain_section_test
}  // namespace filum
