#pragma once
// Time steps as short as the solver needs: a step that does not converge is taken back and repeated at a quarter of its length,
// and the length grows again by half with every step that does. For what need not keep real time: pull tests, validation. A thread so
// light that its motion is quasi-static snaps from one shape to a distant one; short steps resolve the snap, which internal
// friction and drag slow down, where a long one would have to find the new shape through all its contacts at once.
// Test: step_control_test.

#include <functional>

#include "physics/implicit_rod.h"

namespace filum {

class StepControl {
 public:
  StepControl(double shortest, double longest) : shortest_(shortest), longest_(longest), next_(longest) {}

  /// One accepted step. `place(dt)` sets the ends of all prescribed paths for a step of `dt` [s] from the present; it may be
  /// called several times. Returns the length of the step [s]; a step of the shortest length is accepted as it comes.
  double step(ImplicitRod& rod, RodState& s, RodMemory& memory, RodStepOptions options, const std::function<void(double dt)>& place);

  const RodStepSummary& summary() const { return summary_; }  // of the last step
  int repeats() const { return repeats_; }                    // steps taken back so far

 private:
  double shortest_, longest_, next_;
  RodStepSummary summary_;
  int repeats_ = 0;
};

}  // namespace filum
