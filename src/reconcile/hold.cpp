// tip-hold has no input, so nothing is simulated against it: a still tip leaves white noise on a slow polynomial, and effects are
// told apart where they stand in the spectrum. Power in a band is judged by Whittle's likelihood (Whittle 1953): for N periodogram
// values of mean q times the white level, 2 log L rises by 2 N (q - 1 - log q). A line has all of it in one bin, tremor has a band.

#include "reconcile/hold_check.h"
#include "reconcile/hold_decide.h"
#include "reconcile/result.h"

namespace filum::reconcile {

Result reconcile_hold(const Dataset& d, const RigModel& model, const Options& run) {
  const Rules& rules = run.rules;
  Result r;
  say(run, "baseline", 0.0);
  r.rules = rules;
  r.forms = model.all_forms();
  r.lint = lint_hold(d, kHoldRules.lint);
  const HoldRecords records = hold_records(model, rules.noise, r.noise, r.baseline);
  say(run, "lines and bands", 0.1);
  HoldScreenSummary screened = screen_hold(records, r.forms, kHoldRules.screen);
  say(run, "amplitudes", 0.4);
  HoldFitSummary fitted = fit_hold(records, screened, run);
  const std::vector<Found>& found = screened.found;
  r.screen.effects = screened_hold(r.lint, screened.looked);
  r.fit = {static_cast<int>(fitted.effects.size()), fitted.tried.size(), fitted.tried.empty() ? 0u : 1u, r.noise.noise, 1.0};
  say(run, "what is left", 0.6);
  const HoldLeft left = left_beside(records, found, rules.compare.materiality, kHoldRules.decide);
  r.challenge = challenge_hold(records, found, kHoldRules.challenge);
  say(run, "repetitions", 0.7);
  r.detect = detect_hold(records, kHoldRules.detect, run);
  r.decide = decide_hold(records, found, std::move(fitted), left, kHoldRules.decide);
  r.localise = localise_hold(records, found, left, r.decide.verdict, rules.localise);
  if (r.decide.verdict == "unknown") r.describe.shape = describe_hold(records, found, left, rules.describe.resamplings);
  return r;
}

}  // namespace filum::reconcile
