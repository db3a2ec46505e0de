#pragma once
// A still hand's records as its stages see them. Its first stages: lint (what these records could show), noise (the level of the spectrum where neither heart
// nor tremor is) and baseline (a slow polynomial in each record, which takes no starts).

#include "reconcile/baseline.h"
#include "reconcile/hold_spectrum.h"
#include "reconcile/lint.h"

namespace filum::reconcile {

struct HoldRecords {
  Fitter fitter;
  Fit base, fitted;                // all records; those that are not held out
  std::vector<double> stated;      // [m] noise of each output, 0 where nothing is said
  std::vector<double> sigma;       // [m] that was found
  std::vector<Spectrum> all, held; // of the records that are not held out, and of those that are
};

LintSummary lint_hold(const Dataset& d, const HoldLintOptions& options);
/// Fills in `noise` and `baseline`.
HoldRecords hold_records(const RigModel& model, const NoiseOptions& options, NoiseSummary& noise, BaselineSummary& baseline);

}  // namespace filum::reconcile
