#pragma once
// How far a cut edge of a vessel is rolled into its lumen (inversion of the edge: adventitia and media in the stream).
//
//   Roll     A place of the edge's outer rim lies in the stream if it is within the inner surface as that runs on from behind the edge: the
//            outline of an inner ring one to four wall thicknesses back (lengths as first made), carried to the rim's own middle and seen along that
//            ring's normal. Its depth in that outline is the roll; the largest of all places and rings counts. A plain or everted edge has its
//            outer rim a wall's thickness outside: 0. Bent in by 90 degrees over a length L: L less the thickness d. Folded back onto the
//            intima (180 degrees): d. All against the section as it is there, so that lumens drawn in, flat or bent as a whole count nothing.
//   Opening  In the side of a vessel: against the whole rings on both sides of it, carried to the line between their middles.
// Neglects: edges rolled in so evenly over more than four thicknesses that the ring behind is part of the roll. Test: vessel_edge_test.

#include "physics/vessel_mesh.h"

namespace filum {

/// [m], of the cut edge of a part (of the opening, where it has one).
double edge_roll(const VesselMesh& mesh, const Points& x, int part);

}  // namespace filum
