#pragma once
// Tubes that the vessel problems share.

#include <array>
#include <limits>

#include "evidence/validation.h"
#include "physics/tube_slice.h"

namespace filum {

/// Rabbit carotid of Holzapfel, Gasser & Ogden 2000, media and adventitia; opening angle 0 or 160 degrees.
TubeSlice rabbit_carotid(bool opened);

/// Circumferential stress at the surfaces of a slice and on both sides of where its layers meet.
struct SurfaceStress {
  double inner = std::numeric_limits<double>::quiet_NaN(), outer = inner;  // [Pa]
  double media = inner, adventitia = inner;  // [Pa], of a wall of two layers whose elements end there
};

/// Under `pressure` [Pa] inside. What an element has more around than through the wall is free of the mean pressure, which elements know on average
/// only; the surface bears its own load along the normal, which gives the rest, and between the layers -int (s_tt - s_rr) dr/r from there to the
/// outside. Linear elements know the stress at a surface to first order.
SurfaceStress surface_stress(const TubeSlice& slice, const SliceState& state, double pressure);

/// [m], of the nodes where the first of two layers ends.
double interface_radius(const TubeSlice& slice, const SliceState& state);
/// Around the inner or outer surface: length of the elements' sides over what it is without stress.
double surface_stretch(const SliceState& state, bool inner);

/// What is known to first order from three meshes or steps, each twice as fine as the one before: followed to no size from the last two
/// (Richardson), with the observed order and, in the quantity, the value at the finest.
void follow_first_order(ValidationProblem& r, const std::array<double, 3>& coarse_to_fine);

}  // namespace filum
