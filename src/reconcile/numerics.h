#pragma once
// What the numbers behind a fit are worth: what halving the time step and the mesh of the rig's model changes, and whether its derivatives, taken as
// differences, are the same with another step. The first raises the floor of what is material; the second is told.

#include "reconcile/fit.h"

namespace filum::reconcile {

struct Sensitivity {
  std::string parameter;
  double disagreement = 0.0;  // |D(2h) - D(h)| / |D(h)| of the whitened residual over all records, at the step that was taken
  double step = 1.0;          // h, over the usual one
};

struct Numerics {
  double time = 0.0, mesh = 0.0;  // largest rms change of a record, over full scale
  std::vector<Sensitivity> sensitivities;
  double solver() const { return std::max(time, mesh); }
};

/// Above this share a derivative is said to be doubtful.
inline constexpr double kDoubtful = 0.05;

/// Largest rms change of a record's prediction when time steps and when cells are halved.
Numerics solver_error(const Fitter& fitter, const Fit& fit);
/// Differences at h and 2h (Richardson); where they disagree by more than a thousandth, other steps are tried and the best is kept.
std::vector<Sensitivity> check_sensitivities(const Fitter& fitter, const Fit& fit);

}  // namespace filum::reconcile
