#pragma once
// From the samples of several devices to one command for each tool: newest pose, grip angle and squeeze
// wherever they come from, validity by age, and the clutch (held: the tool stays, the hand may move away; let
// go: it goes on from where it was).

#include <array>
#include <cstdint>
#include <limits>

#include "devices/device.h"
#include "world/inputs.h"

namespace filum {

/// From the hand's space to the scene's: p_scene = centre + factor * p_hand. Orientation and grip are not scaled.
struct MotionScale {
  double factor = 1.0;          // scene over hand, e.g. 0.1 to move 1 mm by 10 mm of the hand
  Vec3 centre = Vec3::Zero();   // [m], frame W, where the origin of the hand's space lies
};

class InputMerge {
 public:
  explicit InputMerge(const MotionScale& scale = {}) : scale_(scale) {}
  static constexpr int kMaxSources = 8;

  /// A sample of device number `source`; it holds for `stale_after_us` [us] from its host_time_us. Where
  /// several devices measure the same thing of a tool, the one with the lowest number is believed as long as
  /// it speaks.
  void take(const DeviceSample& sample, int source, std::int64_t stale_after_us) noexcept;
  /// The device is gone: nothing it said is true any more.
  void drop(int source) noexcept;
  /// Commands at time now_us [us]. A tool is valid while it has a pose within reach in the scene (sample_check.h)
  /// and, if its opening was ever measured, an opening.
  Inputs inputs(std::int64_t now_us) noexcept;

 private:
  static constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::min();
  template <class T>
  struct Reading {
    T value{};
    std::int64_t from_us = kNever;   // [us]
    std::int64_t until_us = kNever;  // [us]
    int source = -1;
    bool holds(std::int64_t now_us) const noexcept { return now_us <= until_us; }
  };
  struct Tool {
    Reading<Pose> X_WD;
    Reading<double> angle;  // [rad]
    Reading<double> force;  // [N]
    std::array<Reading<std::uint32_t>, kMaxSources> buttons;
    bool measures_angle = false;  // ever
    bool clutched = false;
    Pose held;                  // where the clutch caught the tool
    Vec3 shift = Vec3::Zero();  // [m], from the hand to the tool
    Quat turn = Quat::Identity();
    ToolInput last;
  };

  static Pose through_clutch(Tool& tool, const Pose& hand, bool clutch) noexcept;

  MotionScale scale_;
  std::array<Tool, kMaxTools> tools_;
};

}  // namespace filum
