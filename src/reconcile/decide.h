#pragma once
// Stage decide: from the set that the evidence asks for, its rivals, and what challenge and re-simulation say of it, to a verdict. The rules stand in
// rules.h; every set that was tried is kept with the reason why it was not taken.

#include <optional>

#include "reconcile/confirm.h"
#include "reconcile/describe.h"
#include "reconcile/fit_sets.h"
#include "reconcile/localise.h"
#include "reconcile/next_experiment.h"
#include "reconcile/numerics.h"
#include "reconcile/rivals.h"

namespace filum::reconcile {

/// One set of effects that was fitted, with why it was not taken.
struct Tried {
  std::vector<Effect> effects;
  std::string form;
  double evidence = 0.0;   // BIC less that of the baseline: the lower the better
  double explained = 0.0;  // share of what the baseline leaves
  bool taken = false;
  std::string why;
};

struct DecideSummary {
  std::string verdict;     // agree, parameter, effect, ambiguous, unknown
  std::string sentence;    // the verdict in words and what would change it
  bool partial = false;
  std::vector<NamedEffect> effects;
  std::vector<Estimate> baseline;               // beside them
  std::vector<Tried> rivals, tried;
  std::vector<std::vector<Effect>> alike_sets;  // sets that the data do not tell apart, the best first, and
  Likeness alike;                               // how alike their signatures are
  Fit before, after;                            // baseline, and what the verdict rests on
  Gap gap;
  double structure_before = 0.0, structure_after = 0.0;  // standard deviations; tip-hold: twice the log likelihood of what is left, before
  Numerics numerics;                            // solver error and sensitivities of `after`
  std::vector<HardwareCheck> units;             // that may be wrong by 1000

  bool missing() const { return verdict != "agree" && verdict != "parameter"; }
};

/// What a verdict rests on beside the fits.
struct Grounds {
  const Fit* winner;  // null: nothing is named
  const std::vector<const Fit*>& rivals;
  const ChallengeSummary& challenged;
  const std::optional<ConfirmSummary>& confirmed;
};
DecideSummary decide(const Candidates& sets, const Grounds& grounds, const Rules& rules, const Run& run);

/// What a next experiment would do, to be added to the verdict's sentence.
std::string what_would(const NextSummary& next, const NextOptions& options);
/// Of what is not named: where most of it sits, the term it follows, what would change the verdict.
std::string what_it_is_like(const LocaliseSummary& where, const std::vector<Term>& shape, bool several_outputs, const Rules& rules);

}  // namespace filum::reconcile
