#include "physics/spatula.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "base/error.h"
#include "base/rng.h"
#include "collision/point_triangle.h"

namespace filum {
namespace spatula_test {

BladeShape flat_blade() {
  BladeShape b;
  b.width = b.tip_width = 10e-3;
  b.length = 40e-3;
  b.taper = 0.0;
  return b;
}

TEST(Spatula, FlatBladeHasItsAreaAndLiesInItsPlane) {
  const RigidSurface s = blade_surface(flat_blade(), 8, 4);
  EXPECT_EQ(s.triangles.size(), 64u);
  double area = 0.0;
  for (const Triangle& t : s.triangles) {
    const Vec3 a = s.vertices.col(t[0]), b = s.vertices.col(t[1]), c = s.vertices.col(t[2]);
    area += 0.5 * (b - a).cross(c - a).norm();
  }
  EXPECT_NEAR(area, 400e-6, 1e-12);
  for (const Vec3& n : s.normals) EXPECT_LT((n - Vec3::UnitY()).norm(), 1e-12);
  EXPECT_LT((s.low - Vec3(-5e-3, 0, 0)).norm(), 1e-12);
}

TEST(Spatula, BendTurnsWhatIsBeyondIt) {
  BladeShape b = flat_blade();
  b.bends = {{20e-3, 0.5, 4e-3}};
  const RigidSurface s = blade_surface(b, 40, 2);
  const Vec3 end = s.vertices.col(s.vertices.cols() - 2), before = s.vertices.col(s.vertices.cols() - 5);
  EXPECT_LT(((end - before).normalized() - Vec3(0, std::sin(0.5), std::cos(0.5))).norm(), 1e-9);
}

TEST(Spatula, NearestPointIsTheBestOfAllTrianglesFromAnyHint) {
  BladeShape b = flat_blade();
  b.bends = {{15e-3, 0.4, 6e-3}};
  const RigidSurface s = blade_surface(b, 20, 5);
  Rng rng(9);
  for (int k = 0; k < 500; ++k) {
    const Vec3 q(rng.uniform(-8e-3, 8e-3), rng.uniform(-6e-3, 12e-3), rng.uniform(-4e-3, 44e-3));
    double least = 1.0;
    for (const Triangle& t : s.triangles)
      least = std::min(least, (closest_on_triangle(q, s.vertices.col(t[0]), s.vertices.col(t[1]), s.vertices.col(t[2])).point - q).norm());
    const SurfacePoint found = nearest_point(s, q);
    EXPECT_NEAR((found.point - q).norm(), least, 1e-12);
    EXPECT_NEAR((nearest_point(s, q, found.triangle).point - q).norm(), least, 1e-12);
  }
}

TEST(Spatula, GapAndDistanceBeyondTheBorder) {
  const RigidSurface s = blade_surface(flat_blade(), 8, 4);
  const SurfacePoint over = nearest_point(s, Vec3(1e-3, 2e-3, 20e-3));
  EXPECT_NEAR(over.gap, 2e-3, 1e-12);
  EXPECT_EQ(over.beyond, 0.0);
  const SurfacePoint outside = nearest_point(s, Vec3(8e-3, -1e-3, 20e-3));
  EXPECT_NEAR(outside.gap, -1e-3, 1e-12);
  EXPECT_NEAR(outside.beyond, 3e-3, 1e-12);
  const SurfacePoint corner = nearest_point(s, Vec3(8e-3, 1e-3, -4e-3));
  EXPECT_NEAR(corner.beyond, 5e-3, 1e-12);
}

// At a corner of the border that belongs to a triangle without a side on it, the distance beyond was taken for none: a node beside a
// tapered blade was then caught as if it lay under it.
TEST(Spatula, DistanceBeyondACornerOfTheBorderIsTheSameFromEveryTriangleAboutIt) {
  BladeShape tapered;
  const RigidSurface s = blade_surface(tapered, 20, 4);
  int corners = 0;
  for (std::size_t t = 0; t < s.triangles.size(); ++t)
    for (const int v : s.triangles[t]) {
      if (s.on_border[static_cast<std::size_t>(v)] == 0) continue;
      const Vec3 at = s.vertices.col(v), out = at.x() > 0.0 ? Vec3::UnitX() : Vec3(-Vec3::UnitX());
      const Vec3 q = at + 3e-3 * out + 1e-3 * Vec3::UnitY();
      if ((nearest_point(s, q).point - at).norm() > 1e-12) continue;  // a side is nearer
      EXPECT_NEAR(nearest_point(s, q, static_cast<int>(t)).beyond, 3e-3, 1e-12) << "triangle " << t << ", corner " << v;
      ++corners;
    }
  EXPECT_GT(corners, 20);
}

TEST(Spatula, ImpossibleBladesAreRefused) {
  const auto refused = [](const std::function<void(BladeShape&)>& spoil) {
    BladeShape b = flat_blade();
    spoil(b);
    try {
      check_blade(b, "blade.yaml");
    } catch (const InputError& e) {
      return e.field;
    }
    return std::string();
  };
  EXPECT_EQ(refused([](BladeShape&) {}), "");
  EXPECT_EQ(refused([](BladeShape& b) { b.width = 30e-3; }), "width");
  EXPECT_EQ(refused([](BladeShape& b) { b.tip_width = 1e-3; }), "tip_width");
  EXPECT_EQ(refused([](BladeShape& b) { b.taper = 1.0; }), "taper");
  EXPECT_EQ(refused([](BladeShape& b) { b.bends = {{1.0, 0.1, 1e-3}}; }), "bends");
}

}  // namespace spatula_test
}  // namespace filum
