#pragma once
// What a vessel wall is between two steps (vessel_wall.h), and a place in it.

#include <vector>

#include "base/pose.h"

namespace filum {

/// A material point of the wall.
struct WallPoint {
  int element = -1;
  Vec3 local = Vec3::Zero();  // xi around, eta along, zeta outward, each in [-1, 1]
};

struct WallState {
  Points x, v;                    // [m], [m/s], 3 x n, frame W
  std::vector<double> soundness;  // of each element: 1 whole, 0 gone
  std::vector<Pose> clamp;        // of each part: where its clamp was at the end of the last step
};

}  // namespace filum
