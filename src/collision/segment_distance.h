#pragma once
// Closest points of two straight segments: the one distance query behind thread, jaws and post.
// Method: Ericson, Real-Time Collision Detection, 2005, sec. 5.1.9, for segments of non-zero length.

#include <algorithm>

#include "base/pose.h"

namespace filum {

struct SegmentPair {
  double s = 0, t = 0;  // parameters in [0, 1] along the first and the second segment
  Vec3 d;               // [m], from the closest point of the second to that of the first
  double distance = 0;  // [m]
};

/// Closest points of p0-p1 and q0-q1. Parallel segments give one of their closest pairs.
inline SegmentPair closest_points(const Vec3& p0, const Vec3& p1, const Vec3& q0, const Vec3& q1) noexcept {
  const Vec3 u = p1 - p0, v = q1 - q0, w = p0 - q0;
  const double a = u.squaredNorm(), e = v.squaredNorm(), f = v.dot(w), c = u.dot(w), b = u.dot(v);
  const double denominator = a * e - b * b;
  SegmentPair r;
  r.s = denominator > 1e-12 * a * e ? std::clamp((b * f - c * e) / denominator, 0.0, 1.0) : 0.5;
  r.t = (b * r.s + f) / e;
  if (r.t < 0.0) {
    r.t = 0.0;
    r.s = std::clamp(-c / a, 0.0, 1.0);
  } else if (r.t > 1.0) {
    r.t = 1.0;
    r.s = std::clamp((b - c) / a, 0.0, 1.0);
  } else if (denominator <= 1e-12 * a * e) {
    r.s = std::clamp((b * r.t - c) / a, 0.0, 1.0);
  }
  r.d = w + r.s * u - r.t * v;
  r.distance = r.d.norm();
  return r;
}

}  // namespace filum
