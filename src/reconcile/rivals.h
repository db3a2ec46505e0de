#pragma once
// Which other sets the data do not tell from the best one.

#include <set>

#include "reconcile/challenge.h"
#include "reconcile/lint.h"

namespace filum::reconcile {

/// Sets that explain what is missing and lie within the tie of the winner's evidence.
std::vector<const Fit*> rivals_of(const Candidates& sets, const Fit& winner, const DecideOptions& options, const std::vector<NotTestable>& hidden);
/// Effects that all of them share with the winner.
std::set<Effect> common(const Fit& winner, const std::vector<const Fit*>& rivals);
/// Instruments first: sets of instruments alone that explain what is missing, where the winner holds more than instruments and neither earns its place
/// beside them as a further effect must, nor leaves less of what was held out. They are rivals, however far behind by evidence.
std::vector<const Fit*> instruments_not_outdone(const Candidates& sets, const Fit& winner, const ChallengeSummary& challenged, const ChallengeOptions& options, const Run& run);
/// Both, each set once; none without a winner.
std::vector<const Fit*> all_rivals(const Candidates& sets, const Fit* winner, const LintSummary& lint, const ChallengeSummary& challenged, const Rules& rules, const Run& run);

}  // namespace filum::reconcile
