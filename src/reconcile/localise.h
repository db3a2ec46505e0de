#pragma once
// Stage localise: in which trial, phase, range, rate, cycle and band of frequency the baseline misses.

#include "reconcile/fit.h"

namespace filum::reconcile {

struct Cell {
  std::string trial, phase, range;
  double share = 0.0;
};

/// One bin of one axis (trial, output, phase, strain or input, rate, cycle, frequency): its part of what lies beyond the noise, and by how many standard
/// deviations of noise alone it does.
struct Share {
  std::string axis, bin;
  double share = 0.0, deviations = 0.0;
};

struct LocaliseSummary {
  std::vector<Cell> cells;  // trial, phase and part of the time together, the largest share first
  std::vector<Share> by;    // axis by axis
};

LocaliseSummary localise(const RigModel& model, const Fit& base, const Noise& noise, const LocaliseOptions& options);
std::vector<Cell> cells_of(const RigModel& model, const Fit& base, const Noise& noise, const LocaliseOptions& options = {});
/// Axis by axis: trial, output, phase, strain (or the input), rate, cycle, band of frequency. Axes on which there is one bin only are left out.
std::vector<Share> shares_of(const RigModel& model, const Fit& base, const Noise& noise, const LocaliseOptions& options = {});

}  // namespace filum::reconcile
