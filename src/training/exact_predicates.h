#pragma once
// Orientation tests that are exact for points on an integer grid: a floating-point filter decides almost
// always, 128-bit integers decide the rest. Coordinates are whole numbers stored as doubles, at most 2^27 in
// magnitude.

#include <cmath>
#include <cstdint>

#include "base/pose.h"

namespace filum {

__extension__ using Int128 = __int128;

/// Sign of det[u v w] for vectors with whole components of at most 2^28.
inline int sign_det(const Vec3& u, const Vec3& v, const Vec3& w) {
  const double a = v.y() * w.z(), b = v.z() * w.y();
  const double c = v.z() * w.x(), d = v.x() * w.z();
  const double e = v.x() * w.y(), f = v.y() * w.x();
  const double det = u.x() * (a - b) + u.y() * (c - d) + u.z() * (e - f);
  const double size = std::abs(u.x()) * (std::abs(a) + std::abs(b)) +
                      std::abs(u.y()) * (std::abs(c) + std::abs(d)) +
                      std::abs(u.z()) * (std::abs(e) + std::abs(f));
  if (std::abs(det) > 2e-15 * size) return det > 0.0 ? 1 : -1;
  const auto whole = [](double x) { return static_cast<Int128>(static_cast<std::int64_t>(x)); };
  const Int128 exact = whole(u.x()) * (whole(v.y()) * whole(w.z()) - whole(v.z()) * whole(w.y())) +
                       whole(u.y()) * (whole(v.z()) * whole(w.x()) - whole(v.x()) * whole(w.z())) +
                       whole(u.z()) * (whole(v.x()) * whole(w.y()) - whole(v.y()) * whole(w.x()));
  return exact > 0 ? 1 : (exact < 0 ? -1 : 0);
}

/// Side of the plane a, b, c on which p lies: sign of det[b-a, c-a, p-a].
inline int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p) {
  return sign_det(b - a, c - a, p - a);
}

}  // namespace filum
