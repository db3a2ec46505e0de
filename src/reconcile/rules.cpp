#include "reconcile/rules.h"

namespace filum::reconcile {

// whoever adds a rule says it in the report, too
static_assert(sizeof(Rules) == 45 * sizeof(double));
static_assert(sizeof(HoldRules) == 14 * sizeof(double));

std::vector<RuleText> listed(const Rules& k) {
  return {{"the baseline starts at the guess, and at it times and over", k.start_factor}, {"starts ended at the same optimum: chi-squared above the best, or", k.start_same}, {"share of the best", k.start_share},
          {"material change, share of full scale", k.materiality}, {"the same in an eighth of a record", k.window_materiality}, {"chance of noise alone to detect", k.detect_p}, {"fall of chi-squared to detect", k.detect},
          {"residual structure that proves a gap, sd", k.structure}, {"fall of BIC to accept, or", k.accept_evidence}, {"chance that the best of the catalogue does as well where nothing is missing", k.accept_p},
          {"share of the gap to be explained", k.explained}, {"the same on held-out protocols", k.held_out}, {"held-out misfit that is judged, sd", k.challenge}, {"folds of protocols at most", static_cast<double>(k.folds)}, {"rates that differ by this factor are not the same", k.rate_apart}, {"a protocol that gets this many times worse could not teach the effect", k.fold_unlearnt},
          {"tie, BIC", k.tie}, {"tie of a rival that these trials could not show", k.aside_tie}, {"tie of a name whose deciding protocol was not run", k.untestable_tie}, {"by which another form must beat the catalogue's, BIC", k.form_preference},
          {"effects at most", static_cast<double>(k.most_effects)}, {"structure left from which a further effect is looked for, sd", k.look_further}, {"a further effect: BIC", k.pair_evidence}, {"a further effect: share of the gap, or", k.pair_share},
          {"this share", k.pair_least}, {"with a change of the prediction, times what is material, of", k.pair_material}, {"or this share (change twice that)", k.pair_clean}, {"if it takes of what is left", k.pair_rest},
          {"or of its gain from samples where the others are silent", k.silent_share}, {"which are at least this part", k.silent_least}, {"partial: sd left", k.partial_structure}, {"partial: share left", k.partial_share},
          {"partial: gain error asked for", k.gain_most}, {"structure left from which it counts as noise in all comparisons, sd", k.overdispersed}, {"refit of parameters that is a verdict: fall of chi-squared each", k.refit},
          {"masked share that hides an effect", k.masked}, {"squared signal to noise that shows one", k.testable}, {"effects screened at most", static_cast<double>(k.screen_most)}, {"sets fitted again when the noise is known, beside instruments alone", static_cast<double>(k.kept_most)}, {"with a share of the best score of", k.screen_share},
          {"and a promised fall of chi-squared of", k.screen_least}, {"a line: price of an amplitude, BIC", k.line_price}, {"each of two lines: chance", k.line_seen}, {"cycles a record below which folded hum does not count", k.line_folded},
          {"harmonics of the motion on which folded hum does not count, if", k.line_harmonics}, {"repetitions that share its phase look so by a chance above", k.line_in_step}};
}

std::vector<RuleText> listed(const HoldRules& k, const Rules& common) {
  return {{"material change, share of full scale", common.materiality}, {"a line: sd above what noise makes of the strongest in its band, and", k.line_spread}, {"fall of chi-squared more", k.line_gain}, {"a line: share of the power about it that stands in it", k.line_share},
          {"tremor: twice the log likelihood", k.tremor_gain}, {"tremor: power over that around", k.tremor_power}, {"tremor: share of one frequency at most", k.tremor_top}, {"tremor: middle from, Hz", k.tremor_low}, {"tremor: middle to, Hz", k.tremor_high},
          {"clipped: equal largest samples", k.clipped_least}, {"clipped: share of all", k.clipped_share}, {"clipped: times the next value's", k.clipped_times}, {"unexplained: twice the log likelihood", k.left_gain}, {"unexplained: power over the noise's", k.left_power},
          {"share of the power that the names must hold", k.named_share}};
}

}  // namespace filum::reconcile
