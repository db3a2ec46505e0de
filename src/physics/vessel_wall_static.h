#pragma once
// Equilibrium of a wall under dead and follower loads: Newton's method with the exact matrix of the elements (follower pressure
// symmetrised), sparse LDL^T with a shifted diagonal where it is indefinite, steps halved until the potential falls. For validation and for
// scenes at load; the moving wall is vessel_wall.h. Test: vessel_wall_static_test.

#include <vector>

#include "physics/vessel_wall_element.h"

namespace filum {

struct WallLoadCase {
  std::vector<char> fixed;        // of each of the 3 n numbers
  std::vector<double> pressure;   // [Pa], of each part; empty: none
  Points force;                   // [N], dead; empty: none
  std::vector<double> soundness;  // of each element, share of its stiffness that is left; empty: all
};

struct StaticSummary {
  bool converged = false;
  int iterations = 0;
  double residual = 0.0;          // [N], largest
};

/// Moves the free numbers of `x` [m] to equilibrium, to `tolerance` [N].
StaticSummary solve_static(const VesselMesh& mesh, const WallElements& elements, const WallLoadCase& load, Points& x, double tolerance,
                           int max_iterations = 60);

/// Reactions [N] at `x`: what fixes the fixed numbers must exert; the residual at the others.
Points reactions(const VesselMesh& mesh, const WallElements& elements, const WallLoadCase& load, const Points& x);

}  // namespace filum
