#pragma once
// What a handle says of its own readings, in the upper bits of DeviceSample::buttons, so that it is recorded beside them. The tools of the
// scene do not see these bits.

#include <cstdint>

namespace filum {

inline constexpr std::uint32_t kButtonBits = 0xFF;      // clutch, cut, next, clamps off, fresh suture
inline constexpr std::uint32_t kAngleSaturated = 0x100;
inline constexpr std::uint32_t kForceSaturated = 0x200;
inline constexpr std::uint32_t kAngleBroken = 0x400;    // wire broken or shorted
inline constexpr std::uint32_t kForceBroken = 0x800;
inline constexpr std::uint32_t kForeignCalibration = 0x1000;  // the handle says it was calibrated, but not by the file in use
inline constexpr std::uint32_t kNotSeen = 0x2000;      // of a demonstration: what the hand reaches for is not there, it waits

}  // namespace filum
