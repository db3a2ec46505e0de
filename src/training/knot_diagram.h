#pragma once
// A closed polygon seen along a direction, as a signed Gauss code: the crossings in the order in which the
// curve meets them, over or under, each with its sign (right-handed = +1). Crossings are decided by exact
// predicates; a direction in which the picture is not in general position is refused and another, seeded one
// is taken.

#include <cstdint>
#include <optional>
#include <vector>

#include "base/pose.h"

namespace filum {

/// Corners of a closed curve; whole-numbered coordinates of at most 2^27 (see to_grid in knot_simplify.h).
using GridPolygon = std::vector<Vec3>;

struct KnotDiagram {
  struct Visit {
    int crossing = 0;  // index into sign
    bool over = false;
  };
  std::vector<Visit> code;  // 2 n visits in order along the curve from its first corner
  std::vector<int> sign;    // n, +1 or -1

  int crossings() const { return static_cast<int>(sign.size()); }
  int writhe() const;
};

/// The diagram seen from infinity along +direction (whole components of at most 2^12); nothing if not in
/// general position.
std::optional<KnotDiagram> project(const GridPolygon& polygon, const Vec3& direction);

/// The diagram with the fewest crossings after reduction (knot_simplify.h) over `tries` seeded directions.
KnotDiagram project_best(const GridPolygon& polygon, std::uint64_t seed, int tries);

}  // namespace filum
