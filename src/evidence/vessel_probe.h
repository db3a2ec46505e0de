#pragma once
// Tubes that the vessel problems share.

#include "physics/tube_slice.h"

namespace filum {

/// Rabbit carotid of Holzapfel, Gasser & Ogden 2000, media and adventitia; opening angle 0 or 160 degrees.
TubeSlice rabbit_carotid(bool opened);

}  // namespace filum
