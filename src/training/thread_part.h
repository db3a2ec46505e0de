#pragma once
// The part of the thread that can hold the knot: without what was cut off and, if the thread has parted, its
// longer piece. In tissue every stitch may lie in a piece of its own: the thread is cut as often as it is tied.

#include <algorithm>

#include "world/observation.h"

namespace filum {

struct ThreadPart {
  int first = 0;  // node
  int last = -1;  // node, inclusive
  int nodes() const { return last - first + 1; }
};

inline ThreadPart tied_part(const Observation& o) {
  ThreadPart part{0, o.n_nodes - 1};
  if (o.cut_edge_low >= 0) part.first = o.cut_edge_low + 1;
  if (o.cut_edge_high >= 0) part.last = o.cut_edge_high;
  if (o.broken && o.break_edge >= part.first && o.break_edge < part.last) {
    const int before = o.break_edge - part.first + 1, after = part.last - o.break_edge;
    if (before >= after) {
      part.last = o.break_edge;
    } else {
      part.first = o.break_edge + 1;
    }
  }
  return part;
}

/// The whole piece about the thread's place `arc` [m] from its first end.
inline ThreadPart piece_at(const Observation& o, double arc) {
  ThreadPart piece{0, o.n_nodes - 1};
  for (int k = 0; k < o.n_parted; ++k) {
    const int edge = o.parted[static_cast<std::size_t>(k)];
    if (o.arc[static_cast<std::size_t>(edge)] < arc) {
      piece.first = edge + 1;
    } else {
      piece.last = edge;
      break;
    }
  }
  return piece;
}

/// Length of the thread between two nodes, along the centreline. [m]
inline double length_between(const Observation& o, int first, int last) {
  double sum = 0.0;
  for (int k = first; k < last; ++k) sum += (o.positions.col(k + 1) - o.positions.col(k)).norm();
  return sum;
}

/// The largest pull in the thread. [N]
inline double largest_tension(const Observation& o) {
  double most = 0.0;
  for (int k = 0; k + 1 < o.n_nodes; ++k) most = std::max(most, o.tension[static_cast<std::size_t>(k)]);
  return most;
}

}  // namespace filum
