#pragma once
// What the records themselves say of the hardware that made them, before any model: clock, gaps, frozen samples, steps of the converter,
// tops that many samples share. Test: hardware_test.

#include "reconcile/dataset.h"

namespace filum::reconcile {

struct HardwareCheck {
  std::string what;   // clock, gap, frozen, quantisation, saturation
  std::string where;  // trial, channel
  std::string found;
};

std::vector<HardwareCheck> check_hardware(const Dataset& d);

}  // namespace filum::reconcile
