#pragma once
// The straight line of a bridge's channel, count = zero + value / gain. What a handle's counts mean (forceps_calibration.h) and what a measured
// forceps is held against (reconcile, forceps-bridge) is this one line. Tests: forceps_calibration_test, rigs_test.

namespace filum {

struct BridgeLine {
  double zero = 0.0;  // [count]
  double gain = 1.0;  // [rad/count] or [N/count], not zero

  double value(double count) const noexcept { return gain * (count - zero); }  // [rad] or [N]
  double count(double value) const noexcept { return zero + value / gain; }
};

}  // namespace filum
