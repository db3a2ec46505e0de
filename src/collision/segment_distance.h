#pragma once
// Closest points of two straight segments: the one distance query behind thread, jaws and post.
// Method: Ericson, Real-Time Collision Detection, 2005, sec. 5.1.9, for segments of non-zero length.

#include <algorithm>
#include <cmath>
#include <limits>

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

/// Closest points of a segment p0-p1 and the surface of a tapered bar (axis q0-q1, radius r0 at q0, r1 at q1, longer than it
/// tapers): minimises distance of the axes minus radius, so that the gap's derivative is along `d` whatever the taper.
/// At the optimum dD/dt = r1 - r0; with D(t)^2 = D0^2 + k^2 (t - t0)^2 that puts t off the closest point t0 of the axes by
/// (r1 - r0) D0 / (k sqrt(k^2 - (r1 - r0)^2)). The gap is convex in (s, t): if its optimum is outside, the least on the
/// border of the square is the answer.
inline SegmentPair closest_to_bar(const Vec3& p0, const Vec3& p1, const Vec3& q0, const Vec3& q1, double r0, double r1) noexcept {
  const double taper = r1 - r0;
  const Vec3 u = p1 - p0, v = q1 - q0, w = p0 - q0;
  const double a = u.squaredNorm(), e = v.squaredNorm(), b = u.dot(v);
  if (taper == 0.0 || e <= 1.01 * taper * taper) return closest_points(p0, p1, q0, q1);
  const auto along_bar = [&](const Vec3& from_q0, double k2, const Vec3& across_u) {  // t, unbounded
    const double t0 = across_u.dot(from_q0) / k2;
    Vec3 d0 = from_q0 - t0 * v;
    if (k2 != e) d0 -= u.dot(d0) / a * u;
    return t0 + taper * d0.norm() / std::sqrt(k2 * (k2 - taper * taper));
  };
  const auto along_segment = [&](double t) { return u.dot(t * v - w) / a; };
  const auto pair_at = [&](double s, double t) {
    const Vec3 d = w + s * u - t * v;
    return SegmentPair{s, t, d, d.norm()};
  };
  const double k2 = e - b * b / a;
  if (k2 > 1.01 * taper * taper) {
    const double t = along_bar(w, k2, v - b / a * u), s = along_segment(t);
    if (s >= 0.0 && s <= 1.0 && t >= 0.0 && t <= 1.0) return pair_at(s, t);
  }
  SegmentPair best;
  double least = std::numeric_limits<double>::infinity();
  for (const double end : {0.0, 1.0}) {
    const SegmentPair at_segment_end = pair_at(end, std::clamp(along_bar(w + end * u, e, v), 0.0, 1.0));
    const SegmentPair at_bar_end = pair_at(std::clamp(along_segment(end), 0.0, 1.0), end);
    for (const SegmentPair& c : {at_segment_end, at_bar_end}) {
      const double gap = c.distance - r0 - c.t * taper;
      if (gap >= least) continue;
      least = gap;
      best = c;
    }
  }
  return best;
}

}  // namespace filum
