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

/// What the last steps taught about the tissue's stiffness: moves s and the changes y of the gradient of elements and inertia that they made, of all numbers.
/// The solver begins with them, so that they are part of the state.
struct WallHistory {
  int n = 0, newest = -1;
  Eigen::MatrixXf s, y;           // [m], [N], a column each
  Eigen::MatrixXd products;       // [J], s_i . y_j of what is not newer and what is
  Eigen::VectorXd least;          // [J], s . y below which a pair is not used
};

struct WallState {
  Points x, v;                    // [m], [m/s], 3 x n, frame W
  std::vector<double> soundness;  // of each element: 1 whole, 0 gone
  std::vector<Pose> clamp;        // of each part: where its clamp was at the end of the last step
  WallHistory history;
};

}  // namespace filum
