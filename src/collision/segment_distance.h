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

/// Where two segments press on each other. The closest points of nearly parallel segments jump from end to end at the slightest turn, and the
/// potential of their distance has a kink there; these minimise |d|^2 + spread2 ((s - 1/2)^2 + (t - 1/2)^2), and go over. `distance` is the root of
/// that: the least distance or up to spread2 / (4 |d|) more. Its gradient is d/distance at (s, t) (envelope theorem), and continuous.
/// Seen otherwise: closest points of segments that lean towards a fourth and a fifth dimension by the root of spread2 [m2], > 0.
inline SegmentPair pressed_points(const Vec3& p0, const Vec3& p1, const Vec3& q0, const Vec3& q1, double spread2) noexcept {
  const Vec3 u = p1 - p0, v = q1 - q0, between_middles = p0 - q0 + 0.5 * (u - v);
  const double a = u.squaredNorm() + spread2, e = v.squaredNorm() + spread2;
  const double b = u.dot(v), c = u.dot(between_middles), f = v.dot(between_middles);
  const auto within = [](double y) { return std::clamp(y, -0.5, 0.5); };
  double s = within((b * f - c * e) / (a * e - b * b)), t = (b * s + f) / e;  // from the middles
  if (std::abs(t) > 0.5) {
    t = within(t);
    s = within((b * t - c) / a);
  }
  const Vec3 d = between_middles + s * u - t * v;
  return {s + 0.5, t + 0.5, d, std::sqrt(d.squaredNorm() + spread2 * (s * s + t * t))};
}

/// Where a segment p0-p1 presses on a tapered bar (axis q0-q1, radius r0 at q0, r1 at q1, longer than it tapers): minimises distance
/// of the axes minus radius, so that the gap's derivative is along `d` whatever the taper; the segment leans as in pressed_points.
/// At the optimum dD/dt = r1 - r0; with D(t)^2 = D0^2 + k^2 (t - t0)^2 that puts t off the closest point t0 of the axes by
/// (r1 - r0) D0 / (k sqrt(k^2 - (r1 - r0)^2)). The gap is convex in (s, t): if its optimum is outside, the least on those sides of
/// the square that are seen from there is the answer.
inline SegmentPair pressed_on_bar(const Vec3& p0, const Vec3& p1, const Vec3& q0, const Vec3& q1, double r0, double r1,
                                double spread2) noexcept {
  const Vec3 u = p1 - p0, v = q1 - q0, w = p0 - q0;
  const double taper = r1 - r0, a = u.squaredNorm() + spread2, b = u.dot(v), c = u.dot(w) - 0.5 * spread2;
  const double e = v.squaredNorm(), f = v.dot(w), g = w.squaredNorm() + 0.25 * spread2;
  const auto along_bar = [taper](double k2, double on_v, double d2) {  // t, unbounded; d2: squared distance of the bar's start
    const double t0 = on_v / k2;
    return t0 + taper * std::sqrt(std::max(0.0, d2 - t0 * on_v) / (k2 * (k2 - taper * taper)));
  };
  const auto along_segment = [&](double t) { return (b * t - c) / a; };
  const auto pair_at = [&](double s, double t) {
    const Vec3 d = w + s * u - t * v;
    return SegmentPair{s, t, d, std::sqrt(d.squaredNorm() + spread2 * (s - 0.5) * (s - 0.5))};
  };
  const auto at_segment_end = [&](double s) { return pair_at(s, std::clamp(along_bar(e, f + s * b, g + s * (2.0 * c + s * a)), 0.0, 1.0)); };
  const auto at_bar_end = [&](double t) { return pair_at(std::clamp(along_segment(t), 0.0, 1.0), t); };
  SegmentPair best;
  double least = std::numeric_limits<double>::infinity();
  const auto offer = [&](const SegmentPair& pair) {
    const double gap = pair.distance - pair.t * taper;
    if (gap >= least) return;
    least = gap;
    best = pair;
  };
  const double k2 = e - b * b / a;
  const bool parallel = k2 <= 1.01 * taper * taper;
  const double t = parallel ? 0.0 : along_bar(k2, f - b * c / a, g - c * c / a), s = along_segment(t);
  if (!parallel && s >= 0.0 && s <= 1.0 && t >= 0.0 && t <= 1.0) return pair_at(s, t);
  if (parallel || s < 0.0) offer(at_segment_end(0.0));
  if (parallel || s > 1.0) offer(at_segment_end(1.0));
  if (parallel || t < 0.0) offer(at_bar_end(0.0));
  if (parallel || t > 1.0) offer(at_bar_end(1.0));
  return best;
}

}  // namespace filum
