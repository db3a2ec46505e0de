#pragma once
// A knot drawn tight by the ends of its rod, which move apart along the line between them.

#include "evidence/rod_probe.h"

namespace filum {

struct DrawnKnot {
  /// `dt`: [s], of a step. The curve's first and last two nodes are held.
  DrawnKnot(const RodMaterial& material, const Points& curve, double friction, double dt = RodStepOptions().dt);

  /// One step; each end moves by speed * dt.
  RodStepSummary pull(double speed);
  double shortening() const;  // [m], length less distance of the ends
  double tension() const;     // [N], of the clamped tail

  RodProbe probe;
  Vec3 direction;  // unit, from the first end to the last
};

}  // namespace filum
