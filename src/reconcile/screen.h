#pragma once
// Stage screen: every effect by the best of its score tests (score_tests.h) or lines (lines.h) against the baseline; what promises enough is fitted.
// Instruments first: as the cheapest explanation they are fitted whenever they promise anything, and take no place from the others.

#include "reconcile/candidates.h"

namespace filum::reconcile {

/// What the score test said of an effect, and what came of it.
struct Screened {
  Effect effect;
  std::string form;        // that of the best start
  double gain = 0.0;       // fall of chi2 that it promises, against the noise as measured; NaN: a line, judged in the spectrum
  double masked = 0.0;     // share of its signature that a refit of the baseline hides
  std::string what;        // fitted, or why not
};

struct ScreenSummary {
  std::vector<Score> chosen;      // starts of the forms to be fitted, against the noise as it was known then
  std::vector<Screened> effects;  // every effect of the rig, when all fits are done
};

/// Further effects beside `from` that are worth a fit: of `options.most` effects at most, `options.forms` forms each.
std::vector<Score> promising(const Candidates& sets, const Fit& from, const ScreenOptions& options);
ScreenSummary screen(const Candidates& sets, const ScreenOptions& options);
/// Every effect of the rig by the best of its score tests against the baseline, and what came of it; `p`: above it a line is one of chance.
std::vector<Screened> screened(const Candidates& sets, const ScreenOptions& options, double p);

}  // namespace filum::reconcile
