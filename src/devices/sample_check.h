#pragma once
// What no device may say, whatever it is: NaN, a pose out of reach, a quaternion that is none, a tool that
// does not exist.

#include "devices/device.h"

namespace filum {

/// [m], of each coordinate: of a hand as its device reports it, and of a tool in the scene. One for all devices, so that what one lets
/// through is not thrown away later.
inline constexpr double kHandReach = 0.5;

enum class SampleFault { none, not_finite, out_of_range, wrong_tool };

/// Looks at the values that are marked present only.
SampleFault fault_of(const DeviceSample& sample) noexcept;

}  // namespace filum
