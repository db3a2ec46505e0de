#pragma once
// Pieces of a thread that was cut: they lie one behind the other in the arrays of one rod, parted edges between them. One can be taken out, and a new one
// joined on behind, in place. Material coordinates stay those of a thread in one piece: what lies behind a piece taken out of the middle comes nearer by
// its length; of one taken from the front, arc_start tells what is gone. Allocates nothing. Test: rod_pieces_test.

#include "physics/implicit_rod.h"

namespace filum {

struct RodPiece {
  int first = 0, last = -1;  // nodes, inclusive
};

/// The piece that begins at node `first`, the one that ends at node `last`.
RodPiece piece_from(const RodState& s, int first) noexcept;
RodPiece piece_to(const RodState& s, int last) noexcept;

/// [m], material coordinate of a node.
double arc_of_node(const RodState& s, int node) noexcept;
/// [m], of the last node, where a needle is swaged; 0 where there is no thread.
double arc_of_end(const RodState& s) noexcept;

/// How material coordinates change when a piece goes. What lay in it has none any more.
struct ArcChange {
  double low = 0.0, high = 0.0, by = 0.0;  // [m], the stretch that goes; what lies behind it comes nearer by so much
  bool gone(double arc) const noexcept { return arc >= low && arc < high; }
  double after(double arc) const noexcept { return arc < high ? arc : arc - by; }
};

/// Takes a piece out, and with it the parted edge behind it (of the last one: the one before it stays, and a piece is to be joined on there). Contacts
/// with it are forgotten; grasps are the caller's.
ArcChange take_out(const RodPiece& piece, RodState& s, RodMemory& memory) noexcept;

/// Joins `piece`, a rod by itself, on behind the last node; `s` may be empty. There must be room for its nodes.
void join_on(const RodState& piece, RodState& s) noexcept;

}  // namespace filum
