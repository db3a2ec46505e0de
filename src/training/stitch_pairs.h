#pragma once
// Which ways through the tissue make one stitch: a bite on one side of a cut and the next bite on the other side, once one piece of thread lies in both.
// A stitch stays one if a bite is torn or pulled out of it later. A bite lost before its partner was made belongs to none, and the one that is
// taken anew in its stead does; so it is with one whose thread was cut. A way through both sides at once (the cut lies between its holes) is a stitch by itself and no half of one.
// Test: stitch_pairs_test.

#include <array>
#include <vector>

#include "world/observation.h"

namespace filum {

/// Torn out or pulled out: no thread is in it.
bool is_lost(const PassObservation& pass) noexcept;
/// Through both sides of the cut at once.
bool is_whole(const PassObservation& pass) noexcept;

class StitchPairs {
 public:
  /// To be told of every change: what belongs together is decided as it comes about.
  void observe(const Observation& observation);
  /// Passes of the stitches made so far, as they were made.
  const std::vector<std::array<int, 2>>& made() const noexcept { return made_; }
  /// And the one whose second bite still has the needle in it.
  std::vector<std::array<int, 2>> with_needle(const TissueObservation& tissue) const;

 private:
  std::vector<std::array<int, 2>> made_;
  int next_ = 0, half_ = -1;  // passes: the next to look at, a bite that waits for the other side
};

}  // namespace filum
