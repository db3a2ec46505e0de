#pragma once
// Techniques that ask for stitches in an order: stays at so many degrees from each other, the posterior wall first, a running thread.
//
// A stitch is made when thread lies in both its bites (training/stitch_pairs.h). Its place is where each of them is around its own stump or edge (CutLine), at rest, as angles from
// where the vessel's angle is zero: a stitch that is straight on one stump and 30 degrees off on the other makes a dog-ear and is at neither place.
// Goals of kind `stitch` are filled one after the other, whatever other goals stand between them. A stitch that the goal whose turn it is
// does not ask for is out of turn: told once, and kept for a later goal that asks for it, since it cannot be unmade.
// Neglects: bites pulled out again after the stitch was made (they stay made). Test: stitch_order_test.

#include <array>
#include <vector>

#include "training/needle_task.h"
#include "training/step_recogniser.h"
#include "training/stitch_pairs.h"
#include "world/observation.h"

namespace filum {

class StitchOrder {
 public:
  StitchOrder(const std::vector<NeedleGoal>& goals, const TissueDescription& tissue);

  /// Looks for stitches newly made. Events: "stitch-out-of-turn" (value: angle, rad).
  void observe(const Observation& o, std::vector<TaskEvent>& events);
  /// Goal `goal` of the task has its stitches.
  bool made(int goal) const;
  /// The stitches of this goal run on from the one before them on one thread that is neither cut nor knotted among them. Takes milliseconds.
  bool runs_on(int goal, const Observation& o) const;
  /// A stitch at this angle [rad] on both sides would be in its turn.
  bool asks_for(double angle) const;
  /// As if one were made there.
  void make(double angle);
  int out_of_turn() const { return out_of_turn_; }
  const StitchPairs& pairs() const { return pairs_; }

 private:
  struct Made {
    int first = 0, second = 0;       // passes
    std::array<double, 2> angle{};   // [rad], on each stump
    int goal = -1;                   // of the task; -1: waits
  };
  const StitchRule& rule(int goal) const { return goals_[static_cast<std::size_t>(goal)].stitch; }
  int turn() const;                  // the goal whose turn it is, -1: none
  bool fits(int goal, const Made& m) const;
  bool follows(int goal, const Made& m) const;
  void take(const Made& m, double time, std::vector<TaskEvent>& events);

  std::vector<NeedleGoal> goals_;
  TissueDescription tissue_;
  std::vector<Made> made_;           // as they were made
  std::vector<int> filled_;          // of each goal: stitches that it has
  StitchPairs pairs_;
  std::size_t taken_ = 0;            // of the pairs
  int out_of_turn_ = 0;
};

}  // namespace filum
