#pragma once
// Ways through a wall: from element to neighbouring element, and how far a point is from the cut edge. Test: needle_track_test.

#include <array>
#include <vector>

#include "physics/vessel_wall.h"

namespace filum {

class WallWalk {
 public:
  explicit WallWalk(const VesselWall& wall);

  /// Material point of the tissue at q, starting from `guess`. inside: false if q lies outside; the point is then the last one within.
  WallPoint move(const VesselWall& wall, const WallState& state, const Vec3& q, const WallPoint& guess, bool& inside) const noexcept;
  /// [m], where the point is in the mesh as first made.
  Vec3 at_rest(const VesselWall& wall, const WallPoint& at) const noexcept;
  /// [m], at rest, from the nearest cut edge of the same part; infinity if it has none.
  double bite(const VesselWall& wall, const WallPoint& at) const noexcept;

 private:
  std::vector<std::array<int, 6>> neighbour_;     // of each element: -xi, +xi, -eta, +eta, -zeta, +zeta; -1 none
  struct Rim {
    int part;
    std::array<Vec3, 4> corner;                   // [m], at rest
  };
  std::vector<Rim> rim_;                          // faces of the cut edges
};

}  // namespace filum
