#pragma once
// The knots that stacks of up to kMostThrows throws can make (two knots of three each in one thread), by Jones polynomial, and reading a stack from a
// diagram.

#include <string>
#include <vector>

#include "training/knot_diagram.h"
#include "training/laurent.h"

namespace filum {

inline constexpr int kMostThrows = 6;

/// Half-twists of the throws whose connected sum has this polynomial, largest first; empty for the unknot or
/// if none has. Throws of 3, 5 and 7 half-twists of either hand are known, up to kMostThrows of them.
std::vector<int> throws_of(const Laurent& jones);

/// The throws from the post outwards if the diagram, met from one tail's end to the other's, is a nest of
/// them; else empty.
std::vector<int> stacked_throws(const KnotDiagram& diagram);

/// "1=1", "2x1": Tera-Aberg notation of throws in order from the post.
std::string composition_of(const std::vector<int>& throws);

/// Class of a stack of throws. `ordered` says whether their order is known; otherwise the order most in use
/// is assumed.
std::string class_of(const std::vector<int>& throws, bool ordered);

}  // namespace filum
