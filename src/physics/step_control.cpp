#include "physics/step_control.h"

#include <algorithm>

namespace filum {

double StepControl::step(ImplicitRod& rod, RodState& s, RodMemory& memory, RodStepOptions options,
                         const std::function<void(double dt)>& place) {
  const RodState before = s;
  const RodMemory remembered = memory;
  for (;;) {
    options.dt = next_;
    place(options.dt);
    summary_ = rod.step(s, memory, options);
    if ((summary_.sound && summary_.converged) || next_ <= shortest_) break;
    s = before;
    memory = remembered;
    next_ = std::max(shortest_, 0.25 * next_);
    ++repeats_;
  }
  if (summary_.converged) next_ = std::min(longest_, 1.5 * next_);
  return options.dt;
}

}  // namespace filum
