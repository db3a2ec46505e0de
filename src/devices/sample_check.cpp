#include "devices/sample_check.h"

#include <cmath>
#include <numbers>

namespace filum {
namespace {

constexpr double kUnitTolerance = 0.01;
constexpr double kAngleLimit = std::numbers::pi;  // [rad]
constexpr double kForceLimit = 50.0;              // [N]

}  // namespace

SampleFault fault_of(const DeviceSample& sample) noexcept {
  if (sample.tool < 0 || sample.tool >= kMaxTools) return SampleFault::wrong_tool;
  if (sample.has_pose) {
    if (!sample.X_WD.finite()) return SampleFault::not_finite;
    if (sample.X_WD.p.cwiseAbs().maxCoeff() > kHandReach) return SampleFault::out_of_range;
    if (std::abs(sample.X_WD.q.norm() - 1.0) > kUnitTolerance) return SampleFault::out_of_range;
  }
  if (sample.has_grip_angle) {
    if (!std::isfinite(sample.grip_angle)) return SampleFault::not_finite;
    if (std::abs(sample.grip_angle) > kAngleLimit) return SampleFault::out_of_range;
  }
  if (sample.has_grip_force) {
    if (!std::isfinite(sample.grip_force)) return SampleFault::not_finite;
    if (sample.grip_force < 0.0 || sample.grip_force > kForceLimit) return SampleFault::out_of_range;
  }
  return SampleFault::none;
}

}  // namespace filum
