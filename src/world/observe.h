#pragma once
// Copies what may be seen of a State into an Observation, and notes what happens.

#include "world/model.h"
#include "world/state.h"

namespace filum {

/// Gives the observation's arrays their size for this scene.
void size_observation(const Model& model, Observation& o);

/// Fills everything but the events and the smallest gap (which the step reports itself), the state hash and the run-time counters.
void fill_observation(const Model& model, const State& s, const RodStepSummary& solver, Observation& o) noexcept;

/// Notes something that happened in this step; `tool`: -1 none. What there is no room for is lost.
inline void say(Observation& o, const char* name, int tool, double value, const char* unit) noexcept {
  if (o.n_events < static_cast<int>(o.events.size())) o.events[static_cast<std::size_t>(o.n_events++)] = {name, tool, value, unit};
}

}  // namespace filum
