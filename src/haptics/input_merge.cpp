#include "haptics/input_merge.h"

#include "devices/sample_check.h"
#include "devices/sample_faults.h"

namespace filum {
namespace {

constexpr std::uint32_t kClutch = 1;

}  // namespace

void InputMerge::take(const DeviceSample& sample, int source, std::int64_t stale_after_us) noexcept {
  if (source < 0 || source >= kMaxSources || fault_of(sample) != SampleFault::none) return;
  Tool& tool = tools_[static_cast<std::size_t>(sample.tool)];
  const std::int64_t from = sample.host_time_us, until = from + stale_after_us;
  const auto put = [&](auto& reading, const auto& value) {
    const bool first_in_line = source < reading.source && until >= reading.from_us;
    const bool newer = source == reading.source && from >= reading.from_us;
    if (first_in_line || newer || !reading.holds(from)) reading = {value, from, until, source};
  };
  if (sample.has_pose) put(tool.X_WD, Pose{sample.X_WD.p, sample.X_WD.q.normalized()});
  if (sample.has_grip_angle) {
    put(tool.angle, sample.grip_angle);
    tool.measures_angle = true;
  }
  if (sample.has_grip_force) put(tool.force, sample.grip_force);
  put(tool.buttons[static_cast<std::size_t>(source)], sample.buttons & kButtonBits);
}

void InputMerge::drop(int source) noexcept {
  if (source < 0 || source >= kMaxSources) return;
  for (Tool& tool : tools_) {
    if (tool.X_WD.source == source) tool.X_WD.until_us = kNever;
    if (tool.angle.source == source) tool.angle.until_us = kNever;
    if (tool.force.source == source) tool.force.until_us = kNever;
    tool.buttons[static_cast<std::size_t>(source)].until_us = kNever;
  }
}

Pose InputMerge::through_clutch(Tool& tool, const Pose& hand, bool clutch) noexcept {
  if (clutch && !tool.clutched) tool.held = {hand.p + tool.shift, (tool.turn * hand.q).normalized()};
  tool.clutched = clutch;
  if (clutch) {
    tool.shift = tool.held.p - hand.p;
    tool.turn = (tool.held.q * hand.q.conjugate()).normalized();
    return tool.held;
  }
  return {hand.p + tool.shift, (tool.turn * hand.q).normalized()};
}

Inputs InputMerge::inputs(std::int64_t now_us) noexcept {
  Inputs inputs;
  for (std::size_t i = 0; i < inputs.tools.size(); ++i) {
    Tool& tool = tools_[i];
    ToolInput& input = tool.last;
    input.valid = tool.X_WD.holds(now_us) && (!tool.measures_angle || tool.angle.holds(now_us));
    input.buttons = 0;
    for (const auto& buttons : tool.buttons)
      if (buttons.holds(now_us)) input.buttons |= buttons.value;
    if (input.valid) {
      const Pose& hand = tool.X_WD.value;
      const Pose scaled{scale_.centre + scale_.factor * hand.p, hand.q};
      const Pose X = through_clutch(tool, scale_.factor == 1.0 && scale_.centre.isZero() ? hand : scaled, (input.buttons & kClutch) != 0);
      // Scaled up, or carried on by the clutch again and again: a tool that would be out of reach has no input until it is back.
      input.valid = X.p.cwiseAbs().maxCoeff() <= kHandReach;
      if (input.valid) input.X_WD = X;
      if (input.valid && tool.measures_angle) input.grip_angle = tool.angle.value;
    }
    input.has_grip_force = input.valid && tool.force.holds(now_us);
    input.grip_force = input.has_grip_force ? tool.force.value : 0.0;
    inputs.tools[i] = input;
  }
  return inputs;
}

}  // namespace filum
