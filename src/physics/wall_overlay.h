#pragma once
// What a viewer may colour a wall by, from where its nodes are and nothing else:
//   strain    largest principal stretch at the middle of an element against a reference shape, less one: lambda_max(F) - 1, F = dx/dX;
//             of a node the mean of its elements
//   pressure  on the surface: p_a = -f_a . N_a / |N_a|^2, f_a = dE/dx_a the force from outside that keeps node a where it is, N_a =
//             int N_a n dA its share of the outward surface. Lumen, jaws, thread and the other cut edge alike; zero inside and where held.
// Exact for homogeneous strain, and for a uniform pressure at rest away from the rims (there two surfaces share a node).
// Neglects: inertia, and that torn elements have lost stiffness (they read too high). Tests: wall_overlay_test.

#include <vector>

#include "physics/vessel_wall_element.h"

namespace filum {

class WallOverlay {
 public:
  /// `reference`: 3 x n [m], the shape without strain.
  WallOverlay(const VesselMesh& mesh, const std::vector<WallLayer>& layers, const Points& reference);

  /// One number for each node; allocates only at first.
  void strain(const Points& x, std::vector<double>& out) const;
  void pressure(const Points& x, std::vector<double>& out) const;  // [Pa], positive: into the tissue

 private:
  VesselMesh mesh_;
  WallElements elements_;
  Points reference_;
  std::vector<char> held_;
  std::vector<int> count_;  // elements of each node
};

}  // namespace filum
