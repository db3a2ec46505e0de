#pragma once
// Tubes that the vessel problems share.

#include <array>
#include <limits>

#include "evidence/validation.h"
#include "physics/tube_slice.h"

namespace filum {

/// Rabbit carotid of Holzapfel, Gasser & Ogden 2000, media and adventitia; opening angle 0 or 160 degrees.
TubeSlice rabbit_carotid(bool opened);

/// Circumferential stress at the surfaces of a slice.
struct SurfaceStress {
  double inner = std::numeric_limits<double>::quiet_NaN(), outer = inner;  // [Pa]
};

/// Under `pressure` [Pa] inside. What an element has more around than through the wall is free of the mean pressure, which elements know on average
/// only; the surface bears its own load along the normal, which gives the rest. Linear elements know the stress at a surface to first order.
SurfaceStress surface_stress(const TubeSlice& slice, const SliceState& state, double pressure);

/// What is known to first order from three meshes or steps, each twice as fine as the one before: followed to no size from the last two
/// (Richardson), with the observed order and, in the quantity, the value at the finest.
void follow_first_order(ValidationProblem& r, const std::array<double, 3>& coarse_to_fine);

}  // namespace filum
