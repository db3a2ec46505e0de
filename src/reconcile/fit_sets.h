#pragma once
// Stage fit: sets of effects, singles as the screening chose them, then pairs and triples while they earn it, best first. Noise and overdispersion are
// measured again whenever a larger set has been fitted.

#include "reconcile/screen.h"

namespace filum::reconcile {

struct FitSummary {
  int fits = 0;             // that were made
  std::size_t sets = 0;     // of effects, kept
  std::size_t most = 0;     // effects in the largest
  Noise noise;              // as the best of them leaves it
  double dispersion = 1.0;  // of what no set takes away, in all comparisons
};

FitSummary fit_sets(Candidates& sets, const ScreenSummary& screened, const FitOptions& options, const ScreenOptions& further, const Run& run);
/// The same set with one effect in another of its forms, where the data do not tell the two apart (within `tie` of BIC).
std::vector<Fit> other_forms(const Candidates& sets, const Fit& winner, double tie, const Run& run);

}  // namespace filum::reconcile
