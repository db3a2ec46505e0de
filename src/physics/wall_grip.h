#pragma once
// What instruments hold of the tissue, between two steps (wall_grasp.h).

#include <array>
#include <cstdint>

#include "physics/wall_state.h"

namespace filum {

/// Two points of the surface, one under each pad. Part of the state.
struct WallGripPlace {
  double z = 0.0;                          // [m], along the pads from their tips
  std::array<WallPoint, 2> at;             // under the pad at +x, at -x
  std::array<Vec3, 2> offset_T{Vec3::Zero(), Vec3::Zero()};  // [m], from the pad's face there to where it holds its point, tool frame
  std::array<Vec3, 2> slid_T{Vec3::Zero(), Vec3::Zero()};    // [m], how far it has slid along the pad since
};
inline constexpr int kMostGripPlaces = 3;

/// What one instrument holds. Part of the state.
struct WallGrip {
  std::int32_t n = 0;                      // places; 0: nothing
  std::int32_t through = 0;                // the wall through its thickness, not its adventitia alone
  double stop = 0.0, leave = 0.0;          // [rad], opening at which the jaws rest on it; beyond which they have let it go
  double pull = 0.0;                       // [N], of the tissue on the instrument in the last step
  std::array<WallGripPlace, kMostGripPlaces> places;
};

}  // namespace filum
