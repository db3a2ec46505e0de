#pragma once
// Makes a knot's picture small without changing the knot: triangle moves on the polygon
// (Koniaris-Muthukumar-Taylor: a corner goes when nothing pierces the triangle it spans), then Reidemeister
// moves I and II on the diagram. Both only ever remove, so they end; the triangle test is exact on the grid,
// so no strand passes through another.

#include <cstdint>

#include "training/knot_diagram.h"

namespace filum {

/// Closed curve on a grid of 2^27 steps across, each point moved by at most 4 steps by a seeded jitter so
/// that no four points are coplanar but by accident. Steps are ~1e-8 of the size of the curve: below a
/// thousandth of a thread radius.
GridPolygon to_grid(const Points& closed_curve, std::uint64_t seed);

/// Removes corners by triangle moves until none can go.
void shrink(GridPolygon& polygon);

/// Removes loops (Reidemeister I) and pairs of opposite crossings (II) until none is left.
void reduce(KnotDiagram& diagram);

}  // namespace filum
