#pragma once
// Closest point of a triangle to a point, by the Voronoi regions of its corners and sides (Ericson, Real-Time Collision
// Detection, 2005, 5.1.5). Test: point_triangle_test.

#include <algorithm>

#include "base/pose.h"

namespace filum {

struct TrianglePoint {
  Vec3 point = Vec3::Zero();
  Vec3 weights = Vec3::Zero();  // of the corners, sum 1; zero where the point lies on the opposite side
};

inline TrianglePoint closest_on_triangle(const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c) noexcept {
  const auto at = [&](double u, double v, double w) { return TrianglePoint{u * a + v * b + w * c, Vec3(u, v, w)}; };
  const Vec3 ab = b - a, ac = c - a;
  const double d1 = ab.dot(q - a), d2 = ac.dot(q - a);
  if (d1 <= 0.0 && d2 <= 0.0) return at(1, 0, 0);
  const double d3 = ab.dot(q - b), d4 = ac.dot(q - b);
  if (d3 >= 0.0 && d4 <= d3) return at(0, 1, 0);
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) {
    const double t = d1 / (d1 - d3);
    return at(1.0 - t, t, 0);
  }
  const double d5 = ab.dot(q - c), d6 = ac.dot(q - c);
  if (d6 >= 0.0 && d5 <= d6) return at(0, 0, 1);
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) {
    const double t = d2 / (d2 - d6);
    return at(1.0 - t, 0, t);
  }
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) {
    const double t = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return at(0, 1.0 - t, t);
  }
  const double sum = 1.0 / (va + vb + vc);
  return at(1.0 - (vb + vc) * sum, vb * sum, vc * sum);
}

}  // namespace filum
