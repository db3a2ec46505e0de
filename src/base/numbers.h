#pragma once
// Numbers that every layer writes.

#include <limits>
#include <numbers>

namespace filum {

inline constexpr double kPi = std::numbers::pi;
inline constexpr double kTurn = 2.0 * kPi;        // [rad]
inline constexpr double kDegree = kPi / 180.0;    // [rad]
inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();  // not known, not measured

}  // namespace filum
