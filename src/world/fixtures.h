#pragma once
// The parts of a scene that do not move: the bars of the practice post, the frame of a sheet and the background sheet, as things that thread and instruments touch.

#include "physics/instrument_contact.h"
#include "world/model.h"

namespace filum {

/// Adds one unmoving body with the bars and the sheet to `obstacles`.
void add_fixtures(const Model& model, RodObstacles& obstacles);

/// What instruments touch: post, frame and sheet. The thin wires of slit and notch give way to them.
Surroundings surroundings(const Model& model);

/// Material coordinate [m] of the thread's point nearest to the slit between the bars.
double arc_on_post(const Model& model, const RodState& thread) noexcept;

}  // namespace filum
