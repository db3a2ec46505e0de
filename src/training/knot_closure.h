#pragma once
// Closes an open thread so that its knot is defined: each tail is led straight out to a far sphere in a
// direction in which nothing is in its way, and the two are joined out there (all ways of joining on the far
// sphere are equal). A direction's merit is the widest cone round it, seen from the tail's tip, that holds no
// part of the thread.

#include <vector>

#include "base/pose.h"

namespace filum {

struct Closure {
  Vec3 first;  // unit, way out for the first node's end
  Vec3 last;   // unit, for the last node's end
};

/// Closures in order of merit: the first is the freest; the others use other free directions that differ by
/// more than 40 degrees from it. At least one, at most `count`.
std::vector<Closure> free_closures(const Points& nodes, int count);

/// The thread with the way out, round and back appended: a closed curve (the last point is joined to the
/// first).
Points close_curve(const Points& nodes, const Closure& closure);

}  // namespace filum
