#pragma once
// What the records themselves say of the hardware that made them, before any model: clock, gaps, frozen samples, steps of the converter,
// tops that many samples share. Test: hardware_test.

#include "reconcile/dataset.h"

namespace filum::reconcile {

struct HardwareCheck {
  std::string what;   // clock, gap, frozen, quantisation, saturation, unit
  std::string where;  // trial, channel
  std::string found;
};

std::vector<HardwareCheck> check_hardware(const Dataset& d);

struct Estimate;
/// What a unit wrong by 1000 would do: fitted values a hundred times above or below those of the model file (friction eight times), diameters that are not the specimen's,
/// speeds and hands that do not move or leap. Said, not refused: a material may be another one than the model's.
std::vector<HardwareCheck> check_units(const Dataset& d, const std::vector<Estimate>& baseline);

}  // namespace filum::reconcile
