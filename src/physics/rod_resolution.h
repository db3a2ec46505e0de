#pragma once
// Resolution that follows the knot: edges are halved where the thread bends sharply or touches itself and joined again where it
// runs straight and free, so that a tight knot of 25 um thread and 80 mm of slack share some 150 nodes.
//
// Halving puts the new node on the edge's own axis: positions, frames and twist are unchanged, nothing can be crossed. Joining
// removes a node only where the turn is slight and no other strand or body is near; the twist of the two edges is kept.
// Rest curvature is carried as curvature times length. Test: rod_resolution_test.

#include "physics/implicit_rod.h"

namespace filum {

struct ResolutionOptions {
  double shortest = 40e-6;     // [m], edges are not halved below this
  double longest = 1.5e-3;     // [m], edges are not joined above this
  double sharp_turn = 0.45;    // [rad], turn at a node above which its edges are halved
  double slight_turn = 0.10;   // [rad], turn below which a node may go
  double touching_edge = 60e-6;  // [m], largest edge in self-contact
  int most_changes = 4;        // a step
};

/// Adapts `s` and the friction memory that names its edges. `contact` and `obstacles` are those of the last step; nodes near a
/// pair or a touch are not removed. `capacity` nodes are never exceeded. Returns the number of changes made.
int adapt_resolution(const ResolutionOptions& o, int capacity, double radius, const RodContact& contact, const RodObstacles& obstacles,
                     RodState& s, RodMemory& memory) noexcept;

/// Halves edge j / removes inner node i.
void halve_edge(RodState& s, int j) noexcept;
void remove_node(RodState& s, int i) noexcept;

}  // namespace filum
