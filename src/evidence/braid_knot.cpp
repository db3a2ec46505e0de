#include "evidence/braid_knot.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/numbers.h"

namespace filum {
namespace {

constexpr double kTail = 0.3;         // [m]
constexpr double kRadius = 1.6e-3;    // [m]
constexpr double kMouth = 0.12 * kPi;  // [rad], half the opening of the loop where the braid is

RodMaterial braid_material() {
  RodMaterial m = RodMaterial::round_wire(kRadius, 0.18e6, 0.5, 1180.0);
  m.drag = 2e-3;
  m.internal_friction = 0.01;
  return m;
}

/// One strand of the braid, from its side below to the other side above.
std::vector<Vec3> braid_strand(int half_turns, double h, double side) {
  const double r = 1.6 * h, width = half_turns * 14.0 * h;
  const int steps = 24 * half_turns;
  std::vector<Vec3> strand;
  for (int k = 0; k <= steps; ++k) {
    const double along = static_cast<double>(k) / steps, turn = half_turns * kPi * along;
    strand.emplace_back(side * 0.5 * width * (1.0 - 2.0 * along), side * r * std::sin(turn), -r * std::cos(turn));
  }
  return strand;
}

/// From the lower left end of the braid round to its lower right end: an ellipse drawn out at its mouth.
void append_loop(double braid_width, double h, double loop, std::vector<Vec3>& curve) {
  constexpr int kSteps = 80;
  const double high = std::max(0.5 * braid_width + 0.01, loop), wide = 1.15 * high;
  const double top = high * std::sin(0.5 * kPi + kMouth);
  const double stretch = 0.5 * braid_width / (wide * std::sin(kMouth));
  for (int k = 1; k < kSteps; ++k) {
    const double angle = 0.5 * kPi + kMouth + (2.0 * kPi - 2.0 * kMouth) * k / kSteps;
    const double near_mouth = std::exp(-std::pow(std::min(k, kSteps - k) / 14.0, 2));
    curve.emplace_back(wide * std::cos(angle) * (1.0 + (stretch - 1.0) * near_mouth), 0.0, high * std::sin(angle) - top - 1.6 * h);
  }
}

/// Evenly spaced, corners rounded.
Points even_and_smooth(const std::vector<Vec3>& curve, double spacing) {
  std::vector<double> arc{0.0};
  for (std::size_t i = 1; i < curve.size(); ++i) arc.push_back(arc.back() + (curve[i] - curve[i - 1]).norm());
  const int n = static_cast<int>(arc.back() / spacing) + 1;
  Points p(3, n);
  for (int i = 0; i < n; ++i) {
    const double s = arc.back() * i / (n - 1);
    const auto k = std::clamp<std::size_t>(static_cast<std::size_t>(std::lower_bound(arc.begin(), arc.end(), s) - arc.begin()), 1, curve.size() - 1);
    p.col(i) = curve[k - 1] + (curve[k] - curve[k - 1]) * ((s - arc[k - 1]) / std::max(1e-12, arc[k] - arc[k - 1]));
  }
  for (int pass = 0; pass < 8; ++pass) {
    const Points old = p;
    for (int i = 1; i + 1 < n; ++i) p.col(i) = 0.25 * old.col(i - 1) + 0.5 * old.col(i) + 0.25 * old.col(i + 1);
  }
  return p;
}

}  // namespace

Points braid_knot_curve(int n, double h, double loop) {
  const int half_turns = 2 * n + 1;
  const std::vector<Vec3> left = braid_strand(half_turns, h, -1.0), right = braid_strand(half_turns, h, 1.0);
  std::vector<Vec3> curve;
  constexpr int kTailSteps = 40;
  for (int k = kTailSteps; k >= 1; --k) curve.push_back(left.back() + Vec3(kTail * k / kTailSteps, 0, 0));
  curve.insert(curve.end(), left.rbegin(), left.rend());
  append_loop(half_turns * 14.0 * h, h, loop, curve);
  curve.insert(curve.end(), right.begin(), right.end());
  for (int k = 1; k <= kTailSteps; ++k) curve.push_back(right.back() - Vec3(kTail * k / kTailSteps, 0, 0));
  return even_and_smooth(curve, 2.0 * h);
}

BraidKnot::BraidKnot(int n, double friction, double loop) : DrawnKnot(braid_material(), braid_knot_curve(n, kRadius, loop), friction) {}

}  // namespace filum
