#pragma once
// What a scene's models look like, told once to those who draw and judge it: no solver is set up for it.

#include "physics/needle_shape.h"
#include "world/brain_model.h"
#include "world/observation.h"
#include "world/vessel_model.h"

namespace filum {

RigidSurface surface_of_shape(const BladeShape& shape);

void describe_brain(const BrainModel& model, BrainDescription& d);
void describe_needle(const NeedleShape& shape, NeedleDescription& d);
void describe_tissue(const VesselModel& model, TissueDescription& d);

}  // namespace filum
