#pragma once
// Overhand knots of unknotting number n (2n + 1 crossings) drawn tight: two strands in a braid of 2n + 1 half-turns, a loop and two
// tails along the braid, as in Jawed, Dieleman, Audoly & Reis (Phys. Rev. Lett. 115:118302, 2015). One segment is one diameter long.

#include "evidence/drawn_knot.h"

namespace filum {

/// Nodes [m] of such a knot for a rod of radius h [m], one diameter apart; the ends leave along the braid, apart from each other. `loop`: half
/// the height of the loop [m].
Points braid_knot_curve(int n, double h, double loop = 0.045);

struct BraidKnot : DrawnKnot {
  BraidKnot(int n, double friction, double loop = 0.045);
};

}  // namespace filum
