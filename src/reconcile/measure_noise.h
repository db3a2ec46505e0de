#pragma once
// Stage noise: what each output's noise is before anything is known to be missing, from the dataset's statement, from replicates or from the fast part of
// what a loosely fitted baseline leaves (structure.h). It is measured again after the baseline and after the fits, when less is left beside it.

#include "reconcile/structure.h"

namespace filum::reconcile {

struct NoiseSummary {
  Noise noise;
  Fit loose;  // the baseline from the rig's guess, before the noise was known
};

/// The noise is set in `fitter`, too.
NoiseSummary measure_noise(Fitter& fitter, const NoiseOptions& options);

}  // namespace filum::reconcile
