#pragma once
// What a step is driven by: one commanded pose and grip for each tool. The recorder stores exactly this, so a replay of the
// stored Inputs gives the same states bit for bit.

#include <array>
#include <cstdint>

#include "base/pose.h"

namespace filum {

struct ToolInput {
  Pose X_WD;                     // commanded pose of the tool frame (origin at the jaw tip, +z towards the handle)
  double grip_angle = 0.3;       // [rad], commanded opening
  double grip_force = 0.0;       // [N], measured squeeze; used only if has_grip_force
  bool has_grip_force = false;
  bool valid = false;            // false: no live device; the tool keeps its last pose and scoring pauses
  std::uint32_t buttons = 0;     // 1 clutch, 2 cut, 4 next, 8 upstream clamp off, 16 downstream clamp off, 32 fresh suture
};

struct Inputs {
  std::array<ToolInput, 3> tools;
};

/// What was heard of a device by the last step. An input comes back only after it was lost.
enum InputState : std::int32_t { kInputNeverHeard = 0, kInputLive = 1, kInputLost = -1 };

/// The state after a step with or without a sound input.
constexpr InputState input_state(bool sound, std::int32_t before) noexcept { return sound ? kInputLive : before == kInputNeverHeard ? kInputNeverHeard : kInputLost; }

/// "input-lost", "input-back", or nullptr where neither happened.
constexpr const char* input_event(std::int32_t before, InputState now) noexcept {
  if (before == kInputLive && now == kInputLost) return "input-lost";
  return before == kInputLost && now == kInputLive ? "input-back" : nullptr;
}

}  // namespace filum
