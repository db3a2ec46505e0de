#include "evidence/linking.h"

#include <cmath>
#include <numbers>

namespace filum {
namespace {

/// Half the solid angle of the triangle of three directions.
double half_angle(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double A = a.norm(), B = b.norm(), C = c.norm();
  return std::atan2(a.dot(b.cross(c)), A * B * C + a.dot(b) * C + b.dot(c) * A + c.dot(a) * B);
}

/// Solid angle of the directions in which edge p q is seen to cross edge r s.
double crossing_angle(const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& s) {
  const Vec3 a = r - p, b = r - q, c = s - q, d = s - p;
  return 2.0 * (half_angle(a, b, c) + half_angle(a, c, d));
}

}  // namespace

double linking_number(const Points& a, const Points& b) {
  double sum = 0.0;
  for (Eigen::Index i = 0; i < a.cols(); ++i)
    for (Eigen::Index j = 0; j < b.cols(); ++j)
      sum += crossing_angle(a.col(i), a.col((i + 1) % a.cols()), b.col(j), b.col((j + 1) % b.cols()));
  return sum / (4.0 * std::numbers::pi);
}

double writhe(const Points& curve) {
  double sum = 0.0;
  for (Eigen::Index i = 0; i + 1 < curve.cols(); ++i)
    for (Eigen::Index j = i + 2; j + 1 < curve.cols(); ++j)
      sum += crossing_angle(curve.col(i), curve.col(i + 1), curve.col(j), curve.col(j + 1));
  return sum / (2.0 * std::numbers::pi);
}

}  // namespace filum
