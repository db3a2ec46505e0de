#pragma once
// Copies what may be seen of a State into an Observation.

#include "world/model.h"
#include "world/state.h"

namespace filum {

/// Gives the observation's arrays their size for this scene.
void size_observation(const Model& model, Observation& o);

/// Fills everything but the events and the smallest gap (which the step reports itself), the state hash and the run-time counters.
void fill_observation(const Model& model, const State& s, const RodStepSummary& solver, Observation& o) noexcept;

}  // namespace filum
