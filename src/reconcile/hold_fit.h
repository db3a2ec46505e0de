#pragma once
// A still hand's stage fit: amplitudes and frequencies of what stands out, each beside all the others.

#include "reconcile/decide.h"
#include "reconcile/hold_screen.h"

namespace filum::reconcile {

struct HoldFitSummary {
  std::vector<NamedEffect> effects;
  std::vector<Tried> tried;
};

/// Frequencies in `screened` are brought to the best.
HoldFitSummary fit_hold(const HoldRecords& records, HoldScreenSummary& screened, const Run& run);

}  // namespace filum::reconcile
