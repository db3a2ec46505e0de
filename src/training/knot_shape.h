#pragma once
// What the topology does not tell: where along the thread the knot sits, whether its loop goes round the
// post, and whether one strand runs straight through it (half-hitches). Used by knot_classifier.

#include <cstdint>
#include <vector>

#include "training/knot_classifier.h"
#include "training/laurent.h"

namespace filum {

/// Jones polynomial of a thread closed the freest way.
Laurent jones_of_thread(const Points& nodes, std::uint64_t seed);

/// The shortest run of nodes that still has the polynomial `jones`: fills core_begin and core_end
/// (bisection).
void find_core(const Points& nodes, const Laurent& jones, std::uint64_t seed, KnotReport& report);

/// Order of the throws, from the post outwards, read by drawing each tail back through the knot: the
/// outermost throw comes undone first. `members` are the throws in any order; empty if what comes undone does
/// not fit them.
std::vector<int> unravel(const Points& nodes, std::vector<int> members, std::uint64_t seed,
                         const KnotReport& report);

/// Fills post_winding and encloses_post from the core, closed by a straight chord.
void measure_post(const Points& nodes, const PostShape& post, KnotReport& report);

/// Fills strand_turning; turns square, granny, surgeons and triple into half-hitches where the rule in
/// knot_classifier.h holds.
void judge_lay(const Points& nodes, double radius, KnotReport& report);

}  // namespace filum
