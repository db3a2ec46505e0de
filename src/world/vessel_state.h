#pragma once
// Tissue of a scene: what changes from step to step.

#include <array>
#include <cstdint>

#include "physics/track_state.h"

namespace filum {

/// A point of the thread that pushes against the surface. Part of the state.
struct ThreadTouch {
  double arc = 0.0;            // [m], of the thread
  WallPoint at;                // of the surface
  Vec3 normal = Vec3::UnitZ();  // outward, when last looked at
  double load = 0.0;           // [N], normal, in the last step
};
inline constexpr int kMostTouches = 48;

struct TouchState {
  std::int32_t n = 0;
  std::array<ThreadTouch, kMostTouches> touches;
};

struct VesselState {
  WallState wall;
  TrackState tracks;
  TouchState touches;
  std::array<double, 2> pressure{};  // [Pa], transmural, of each stump
};

}  // namespace filum
