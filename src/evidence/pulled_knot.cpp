#include "evidence/pulled_knot.h"

#include <vector>

namespace filum {
namespace {

RodMaterial knot_material() {
  RodMaterial m = RodMaterial::round_wire(1.6e-3, 0.18e6, 0.5, 1180.0);
  m.drag = 1e-3;
  return m;
}

}  // namespace

Points overhand_curve(int n, double length) {
  constexpr int kFine = 4000;
  std::vector<Vec3> curve;
  std::vector<double> arc{0.0};
  for (int k = 0; k <= kFine; ++k) {
    const double t = -2.3 + 4.6 * k / kFine, t2 = t * t;
    curve.emplace_back(t * (t2 - 3.0), t2 * (t2 - 4.0), 0.2 * t * (t2 * t2 - 10.0));
    if (k > 0) arc.push_back(arc.back() + (curve[k] - curve[k - 1]).norm());
  }
  Points p(3, n);
  double total = 0.0;
  for (int i = 0, k = 0; i < n; ++i) {
    const double s = arc.back() * i / (n - 1);
    while (k + 2 < static_cast<int>(curve.size()) && arc[k + 1] < s) ++k;
    p.col(i) = curve[k] + (curve[k + 1] - curve[k]) * ((s - arc[k]) / (arc[k + 1] - arc[k]));
    if (i > 0) total += (p.col(i) - p.col(i - 1)).norm();
  }
  return p * (length / total);
}

PulledKnot::PulledKnot(int n, double friction, double dt) : DrawnKnot(knot_material(), overhand_curve(n, 1.0), friction, dt) {}

}  // namespace filum
