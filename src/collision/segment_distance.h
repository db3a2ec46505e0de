#pragma once
// Closest points of two straight segments: the one distance query behind thread, jaws and post.
// Method: Ericson, Real-Time Collision Detection, 2005, sec. 5.1.9, for segments of non-zero length.

#include <algorithm>
#include <cmath>

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

/// Closest points of a segment p0-p1 and the surface of a tapered bar (axis q0-q1, radius r0 at q0, r1 at q1): minimises
/// distance of the axes minus radius, so that the gap's derivative is along `d` whatever the taper.
/// At the optimum dD/dt = r1 - r0; with D(t)^2 = D0^2 + k^2 (t - t0)^2 that puts t off the closest point t0 of the axes by
/// (r1 - r0) D0 / (k sqrt(k^2 - (r1 - r0)^2)).
inline SegmentPair closest_to_bar(const Vec3& p0, const Vec3& p1, const Vec3& q0, const Vec3& q1, double r0, double r1) noexcept {
  SegmentPair c = closest_points(p0, p1, q0, q1);
  const double taper = r1 - r0;
  if (taper == 0.0) return c;
  const Vec3 u = p1 - p0, v = q1 - q0;
  const double a = u.squaredNorm(), e = v.squaredNorm(), b = u.dot(v);
  for (int k = 0; k < 2; ++k) {  // again if the shift takes the segment's point to its end
    const bool inside = c.s > 0.0 && c.s < 1.0;
    const double k2 = inside ? e - b * b / a : e;
    if (k2 <= 1.01 * taper * taper) return c;
    // Axis parameter nearest to the segment's line, or to its end.
    const Vec3 w = (inside ? p0 : Vec3(p0 + c.s * u)) - q0;
    const double t0 = inside ? (v.dot(w) - b * u.dot(w) / a) / k2 : v.dot(w) / e;
    Vec3 d0 = w - t0 * v;
    if (inside) d0 -= u.dot(d0) / a * u;
    c.t = std::clamp(t0 + taper * d0.norm() / std::sqrt(k2 * (k2 - taper * taper)), 0.0, 1.0);
    const double s = std::clamp(u.dot(q0 + c.t * v - p0) / a, 0.0, 1.0);
    const bool same = (s > 0.0 && s < 1.0) == inside;
    c.s = s;
    if (same) break;
  }
  c.d = p0 + c.s * u - q0 - c.t * v;
  c.distance = c.d.norm();
  return c;
}

}  // namespace filum
