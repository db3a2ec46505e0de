#pragma once
// Who moves a blade in a step: the hand, the self-retaining arm, or somebody who puts it on its arm before the trainee begins.
//   hand    the blade follows the commanded pose, no faster than the limits; taken over where it is, so nothing jumps
//   arm     keeps its pose, or its force: a yielding joint, c v = (F - f.k) (-k), along the direction k in which the tissue pushed
//           with F when it was locked; it creeps after tissue that relaxes, and gives way to tissue that swells. The joint takes the
//           force of the last step, so it must give less in a step than the damped tissue answers: c > dt (1 + 2 b/dt) K/2
//   placed  goes from key to key of the scene file, then stays on its arm
// The clutch (button 1) locks while it is pressed; `next` (button 4) locks and, pressed again, frees. `cut` (button 2) asks for the
// blade's next form, which it is given in the hand and clear of the tissue only. Test: blade_arm_test.

#include "world/brain_model.h"
#include "world/inputs.h"
#include "world/observation.h"

namespace filum {

inline constexpr double kArmYield = 250.0;     // c [N s/m]
inline constexpr double kArmFastest = 5e-3;    // [m/s], of a yielding arm
inline constexpr double kArmLeast = 10e-3;     // [N], below it there is no force to keep
inline constexpr double kBladeTurnRate = 3.0;  // [rad/s], at most

/// Moves blade `i` by a step dt [s] that begins at `time` [s]; reports what changes into o.
void move_blade(const BrainModel& model, std::size_t i, const ToolInput& in, double time, double dt, BladeState& blade, std::int32_t& valid, Observation& o) noexcept;

/// True in the step in which a hand that holds the blade begins to ask for its next form.
bool asks_for_form(const BrainModel& model, std::size_t i, const ToolInput& in, double time, BladeState& blade) noexcept;

/// Where a placed blade is at this time.
Pose placed_at(const std::vector<PlacedKey>& keys, double time) noexcept;

}  // namespace filum
