#include "reconcile/rules.h"

#include <cmath>

namespace filum::reconcile {

// whoever adds a rule says it in the report, here or among the options of its stage (stages.cpp)
static_assert(sizeof(Rules) == 528);
static_assert(sizeof(HoldRules) == 136);

namespace {

constexpr const char* kNone = "-";
constexpr const char* kScreening = "keeps the time; what is left out promises too little to be named";

std::vector<RuleText> deciding(const Rules& k) {
  return {
      {"material change, share of full scale", "tau = 0.006, or the solver's error if more", k.compare.materiality, ""},
      {"the same in an eighth of a record", kNone, k.compare.window_materiality, "events shorter than a record (puncture, pull-off) change its mean little"},
      {"chance of noise alone to detect", "0.01", k.detect.p, ""},
      {"fall of chi-squared to detect", kNone, k.compare.fall, "the best of a catalogue reaches 11 to 14 by chance"},
      {"residual structure that proves a gap, sd", kNone, k.decide.structure, "for what no candidate's test sees"},
      {"fall of BIC to accept, or", "10", k.compare.accept_evidence, ""},
      {"chance that the best of the catalogue does as well where nothing is missing", kNone, k.compare.accept_p, "BIC's log n asks more than a weak effect of two or three values can pay"},
      {"share of the gap to be explained", "0.70", k.compare.explained, ""},
      {"the same on held-out protocols", "0.50", k.decide.held_out, ""},
      {"held-out misfit that is judged, sd", kNone, k.challenge.judged, "a share of next to nothing is noise"},
      {"folds of protocols at most", "each protocol (4.2)", static_cast<double>(k.challenge.folds), "keeps the time; many protocols share a fold"},
      {"rates that differ by this factor are not the same", "fit slow, validate fast (4.2)", k.challenge.rate_apart, "replicates of one rate differ by jitter only"},
      {"a protocol that gets this many times worse could not teach the effect", kNone, k.challenge.unlearnt, "an effect that acts in one protocol only cannot be learnt without it"},
      {"tie, BIC", "6, or signatures that correlate by 0.95", k.decide.tie, "likeness is told, not ruled by: evidence parts even what correlates"},
      {"tie of a rival that these trials could not show", kNone, k.decide.aside_tie, "it stands among what is not testable already"},
      {"tie of a name whose deciding protocol was not run", kNone, k.decide.untestable_tie, "its own form's error could be all that leads"},
      {"by which another form must beat the catalogue's, BIC", kNone, k.compare.form_preference, "wide families name what lies outside the catalogue"},
      {"effects at most", "3 (4.2)", static_cast<double>(k.compare.most_effects), ""},
      {"structure left from which a further effect is looked for, sd", "30 % of the excess left (4.2)", k.fit.look_further, "small effects beside large ones leave less than that"},
      {"a further effect: BIC", kNone, k.compare.pair_evidence, "stricter than a first one"},
      {"a further effect: share of the gap, or", "0.15 (4.2)", k.compare.pair_share, "the smaller of two unequal effects; the rules below keep form errors out"},
      {"this share", kNone, k.compare.pair_least, "less is the first effect's form error"},
      {"with a change of the prediction, times what is material, of", kNone, k.compare.pair_material, "the same"},
      {"or this share (change twice that)", kNone, k.compare.pair_clean, "beside a very large effect"},
      {"if it takes of what is left", kNone, k.compare.pair_rest, "then hardly anything else can be meant"},
      {"or of its gain from samples where the others are silent", kNone, k.compare.silent_share, "no form of the others can err there"},
      {"which are at least this part", kNone, k.compare.silent_least, "the same"},
      {"instruments alone, explaining enough, are rivals unless the name earns its place beside them or predicts better: order of stages", "instrument first (4.2)", NAN, "stage of the catalogue; they are fitted whenever they promise anything"},
      {"partial: sd left, and", "explained 0.4 to 0.7", k.decide.partial_structure, "below 0.7 nothing is named at all; partial is a name that leaves structure"},
      {"partial: share left", "explained 0.4 to 0.7", k.decide.partial_share, "the same"},
      {"partial: gain error asked for", "inside bounds", k.decide.gain_most, "no instrument's gain is off by more than 1 % (contract)"},
      {"structure left from which it counts as noise in all comparisons, sd", "sigma left free (2.8)", k.compare.overdispersed, "a fit that is good enough needs no wider yardstick"},
      {"refit of parameters that is a verdict: fall of chi-squared each", "explained 0.70", k.decide.refit, "and material: with nothing else missing a refit explains all there is"},
  };
}

std::vector<RuleText> searching(const Rules& k) {
  return {
      {"the baseline starts at the guess, and at it times and over", "8 starts (4.2)", k.baseline.factor, "three: with one to four free values they end in the same place in nearly all sets"},
      {"starts ended at the same optimum: chi-squared above the best, or", kNone, k.baseline.same, "less tells no two models apart"},
      {"share of the best", kNone, k.baseline.share, "a baseline that misfits stops at 1e-5 of it"},
      {"masked share that hides an effect", "0.9 (2.6)", k.lint.masked, "0.9 is said beside the effect; at 0.999 nothing is left to be named by"},
      {"squared signal to noise that shows one", "16 (4.5: SNR of 4)", k.lint.testable, ""},
      {"effects screened at most, beside instruments", "6 (4.2)", static_cast<double>(k.screen.most), "score tests of far starts promise unevenly"},
      {"sets fitted again when the noise is known, beside instruments alone", kNone, static_cast<double>(k.fit.kept_most), kScreening},
      {"with a share of the best score of", kNone, k.screen.share, kScreening},
      {"and a promised fall of chi-squared of", kNone, k.screen.least, kScreening},
      {"a line: price of an amplitude, BIC", kNone, k.compare.line_price, "phases are free: log n an amplitude is too much (search.cpp)"},
      {"each of two lines: chance", kNone, k.line.seen, "breath and heart are named together only where both are seen"},
      {"cycles a record below which folded hum does not count", kNone, k.line.folded, "slow misfit stands there"},
      {"harmonics of the motion on which folded hum does not count, if", kNone, k.line.harmonics, "what a misfit makes of a periodic motion stands there"},
      {"repetitions that share its phase look so by a chance above", kNone, k.line.in_step, "hum has any phase"},
  };
}

std::vector<RuleText> taken_as_given(const Rules& k) {
  using namespace assumed;
  return {
      {"noise of full scale until the first fit", kNone, k.noise.first, "replaced by what replicates or neighbours differ by"},
      {"noise of full scale for lint", kNone, k.lint.noise, "what is stated, if that is less"},
      {"scatter of the records' stiffness until replicates are fitted", "5 to 25 % (4.5)", k.noise.first_scatter, "contract: 5 to 10 %"},
      {"scatter believed from", kNone, kScatterLow, "a handle's records, and few replicates that happen to agree"},
      {"to", kNone, kScatterHigh, "the contract's 10 % and a margin"},
      {"without replicates", kNone, kScatterAlone, "more would hide what differs between protocols"},
      {"where blades of two sizes are compared", kNone, k.baseline.blade_scatter, "the factor of a punch is an estimate"},
      {"scatter of gains", kNone, kGainScatter, "contract: up to 1 %, evenly"},
      {"noise that half remembers: twice the log likelihood", "AR(1) or AR(2) and white (2.1)", kWhiteWorth, "once in 200 sets where there is none"},
      {"noise over what is stated, at most", kNone, kStatedMost, "jitter and converter add to it"},
      {"correlation of neighbours that is noise's own", kNone, kMemoryLeast, "its own error in 150 samples"},
      {"jitter of a clock, of a step", "1 ms (4.5)", kJitter, "contract: ordinary"},
      {"curvature's intervals are widened by", "profile likelihood", kWiden, "laws are not quite the true ones; with it 90 to 93 % covered in the development half"},
      {"relative error of form and gain in an interval", kNone, kForm, "which no fit can see"},
      {"the same of a line's frequency", kNone, kClock, "rate of a clock"},
      {"an amplitude's interval is widened by", kNone, kLineWiden, "a mean of few records"},
      {"a start is far at amplitudes beyond", kNone, kFarStart, "a score test is a first step"},
      {"and its promise counts", kNone, kFarPromise, "the same"},
      {"a heart beat needs sampling, Hz", kNone, k.lint.heart_sampling, "0.8 to 2 Hz, even folded"},
      {"and a record of, s", kNone, k.lint.heart_span, "some beats"},
      {"tremor needs sampling, Hz", kNone, k.lint.tremor_sampling, "twice 8 Hz and a margin"},
      {"hum needs sampling, Hz", kNone, k.lint.hum_sampling, "slower, 50 Hz folds onto anything"},
      {"and samples in the longest record", kNone, k.lint.hum_samples, "the same"},
      {"hum lies within, Hz of 50 or 60", kNone, kHumBand, "what a grid strays"},
      {"periods of a line in the longest record", kNone, kLinePeriods, "less is not told from what is slow"},
      {"sets to which a second effect is added", "pairs of what passed", static_cast<double>(k.fit.pair_parents), kScreening},
      {"and a third", "at most three", static_cast<double>(k.fit.triple_parents), kScreening},
      {"effects added to each, second", kNone, static_cast<double>(k.fit.pair_effects), kScreening},
      {"and third", kNone, static_cast<double>(k.fit.triple_effects), kScreening},
      {"forms of an effect that are fitted alone", "each", static_cast<double>(k.screen.forms), kScreening},
      {"and beside others", "each", static_cast<double>(k.fit.further_forms), kScreening},
      {"repetitions of the baseline", "200 (4.2)", static_cast<double>(k.detect.repetitions), "a chance of 0.0025 asks for more"},
      {"rounds of the full solver's mapping at most", kNone, static_cast<double>(k.confirm.rounds), "where it has not come to rest the last one stands"},
      {"change of full scale at which it rests", kNone, k.confirm.rest, "a sixth of what is material"},
      {"simulated records of a next experiment", "50 (4.2)", static_cast<double>(k.next.records), ""},
      {"share that must decide to be likely to", "0.80 (4.5, an aim)", k.next.likely, "the chance is told as it is; below a half it is called unlikely"},
      {"share of resamplings that choose a term that is told", kNone, k.describe.chosen, "a third of 30"},
  };
}

}  // namespace

std::vector<RuleText> listed(const Rules& k) {
  std::vector<RuleText> out = deciding(k);
  for (auto& more : {searching(k), taken_as_given(k)}) out.insert(out.end(), more.begin(), more.end());
  return out;
}

std::vector<RuleText> listed(const HoldRules& k, const Rules& common) {
  const char* spectral = "the spectrum of a still hand is judged by its own likelihood, not by BIC";
  return {
      {"material change, share of full scale", "0.006", common.compare.materiality, ""},
      {"a line: sd above what noise makes of the strongest in its band, and", kNone, k.screen.line_spread, spectral},
      {"fall of chi-squared more", "dBIC 10", k.screen.line_gain, spectral},
      {"a line: share of the power about it that stands in it", kNone, k.screen.line_share, "less is a band"},
      {"tremor: twice the log likelihood", "dBIC 10", k.screen.tremor_gain, spectral},
      {"tremor: power over that around", kNone, k.screen.tremor_power, "less is the spectrum's own slope"},
      {"tremor: share of one frequency at most", kNone, k.screen.tremor_top, "more is a line"},
      {"tremor: middle from, Hz", "8", k.screen.tremor_low, "a band's middle is known to its width"},
      {"tremor: middle to, Hz", "12", k.screen.tremor_high, "the same"},
      {"clipped: equal largest samples", kNone, k.screen.clipped_least, "a converter's steps repeat a few"},
      {"clipped: share of all", kNone, k.screen.clipped_share, "the same"},
      {"clipped: times the next value's", kNone, k.screen.clipped_times, "the same"},
      {"unexplained: twice the log likelihood", kNone, k.decide.left_gain, spectral},
      {"unexplained: power over the noise's", kNone, k.decide.left_power, "less is not material"},
      {"share of the power that the names must hold", "0.70", k.decide.named_share, "of the power, not of a misfit: what is left counts noise, too"},
  };
}

}  // namespace filum::reconcile
