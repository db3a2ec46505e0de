#pragma once
// What no device may say, whatever it is: NaN, a pose out of reach, a quaternion that is none, a tool that
// does not exist.

#include "devices/device.h"

namespace filum {

enum class SampleFault { none, not_finite, out_of_range, wrong_tool };

/// Looks at the values that are marked present only.
SampleFault fault_of(const DeviceSample& sample) noexcept;

}  // namespace filum
