#pragma once
// The knot of a stitch. The thread closes through the tissue by itself (the part between the bites is thread like any other), so a stitch
// that is tied is a knotted thread whose knot cannot be had without the bites: the shortest part of the thread that holds the whole knot
// (knot_classifier.h) reaches over both. A knot in a thread beside the stitch ties nothing.
//   loop  length of that part: thread in bites and knot together; falls to its least when the knot is drawn down on the wall
//   tail  the longer of the ends that were cut, or the short end if none was; short_tail: the shorter
// Each whole piece of the thread is looked at by itself. A running thread is tied twice in one piece, at its first stitch and at its end, which close to the sum of both knots.
// The first is the knot of the thread up to one of the ways that the sum holds; the last, what the sum has beside it: that holds all stitches, and is named without the first.
// Neglects: more than two knots in one piece (the second and the third are named as one). Test: stitch_knot_test.

#include <limits>
#include <vector>

#include "training/knot_classifier.h"
#include "training/lapse.h"
#include "training/thread_part.h"
#include "world/observation.h"

namespace filum {

struct StitchKnot {
  KnotReport knot;
  double begin = std::numeric_limits<double>::quiet_NaN(), end = begin;  // [m], of the part with the knot, from the thread's short end
  double tail = begin, short_tail = begin;                               // [m]
  double loop() const { return end - begin; }
  /// The thread at `arc` [m] from the short end lies within the knot's loop.
  bool holds(double arc) const { return arc > begin && arc < end; }
};

/// `closures`: as in KnotOptions. `cut_in_front`: the piece's first end is a cut one; a fresh suture lies behind other pieces and begins whole.
/// Takes milliseconds.
StitchKnot knot_in_piece(const Observation& o, const ThreadPart& piece, int closures = 5, bool cut_in_front = false);

/// Of each piece that goes through tissue; of one tied twice the last knot and then the first. `whole_front`: of each way, whether its suture still begins where it was laid; all do if it is empty.
std::vector<StitchKnot> knots_in_tissue(const Observation& o, int closures = 5, const std::vector<char>& whole_front = {});

/// [m], shortest way round the bites that the knot's loop holds, as they are now: from hole to hole in straight lines, and back.
double way_round(const StitchKnot& knot, const TissueObservation& tissue);

/// Tells each stitch the knot that it is tied with, and the slack of its loop, of which each of the stitches in one loop has a part. A knot drawn down keeps what is in the knot
/// itself, 20 to 30 diameters. Knots as knots_in_tissue has them: a stitch's own comes after that of the whole thread.
void name_knots(const StitchKnot& knot, const TissueObservation& tissue, std::vector<Stitch>& stitches);

}  // namespace filum
