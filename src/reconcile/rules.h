#pragma once
// Every number by which reconcile decides, in one place, in the order of its stages (each stage's header takes its own Options from here); printed in each
// report. Defaults follow reference/discovery.md 4.3; what was changed on the development half is said beside it.

#include <string>
#include <vector>

namespace filum::reconcile {

/// lint.h
struct LintOptions {
  double masked = 0.999;             // share of a signature that the baseline's refit swallows: not testable
  double testable = 16.0;            // squared signal to noise below which an effect cannot be seen
  double noise = 0.01;               // of full scale, in which is asked what could be seen, where none is stated that is less
  double heart_sampling = 1.0, heart_span = 3.0;  // [Hz], [s]: less does not show a heart beat of 0.8-2 Hz, even folded
  double tremor_sampling = 17.0;     // [Hz], twice 8 Hz and a margin
  double hum_sampling = 1.5, hum_samples = 24.0;  // [Hz], and in the longest record: less, and 50 Hz folds onto anything
};

/// measure_noise.h
struct NoiseOptions {
  double first = 0.02;               // of full scale, of an output of which nothing is stated, until the first fit
  double first_scatter = 0.10;       // of the records' stiffness, until replicates have been fitted (contract: 5-10 %)
};

/// baseline.h
struct BaselineOptions {
  double factor = 5.0;               // scale parameters start at 1/factor, 1 and factor times the first guess, within their bounds
  double same = 1.0;                 // chi2 above the best, up to which a start ended at the same optimum, or
  double share = 1e-3;               // this share of the best chi2 if that is more (a baseline that misfits stops at 1e-5 of it)
  double blade_scatter = 0.2;        // of blades of two sizes: the factor of a punch is an estimate
};

/// candidates.h: how sets of effects are weighed against each other, by every stage from here on
struct CompareOptions {
  double materiality = 0.006;        // of full scale: smaller changes of the prediction (rms of a record) are not worth a name
  double window_materiality = 0.02;  // the same in an eighth of a record (short events)
  double fall = 18.0;                // of chi2 (over the overdispersion) that the best effect must bring, and what silent samples must say
  double accept_evidence = 10.0;     // fall of BIC against the baseline, or
  double accept_p = 0.0025;          // chance that in a set where nothing is missing the best of the catalogue does as well (parametric bootstrap; a
                                     // line: by the spectrum): BIC's log n asks a prior that a weak effect of two or three values cannot pay
  double explained = 0.70;           // share of the structure that a name must explain
  double pair_evidence = 12.0;       // fall of BIC that a further effect must bring
  double pair_share = 0.05;          // of the structure that a further effect must explain, or
  double pair_least = 0.025;         // this share, if it changes the prediction by
  double pair_material = 1.2;        // times the materiality (development half: less is the first effect's form error), or
  double pair_clean = 0.01;          // this share, if it also takes
  double pair_rest = 0.80;           // of what the smaller set leaves
  double silent_share = 0.50;        // or if this share of its gain comes from where the smaller set changes less than the materiality, if that is
  double silent_least = 0.15;        // at least this part of the samples: no form of the smaller set can err there
  double form_preference = 4.0;      // of BIC, by which another form must beat the one of the catalogue
  double overdispersed = 3.0;        // standard deviations of structure left in the best fit from which it counts as noise in all comparisons
  double line_price = 3.0;           // of BIC an amplitude of a line of free phase, in place of log n (candidates.cpp)
  int most_effects = 3;
};

/// lines.h
struct LineOptions {
  double seen = 0.05;                // chance below which each of two lines that are named together must stand out
  double folded = 6.0;               // cycles a record: where slow sampling folds hum to less, the record does not count for it
  double harmonics = 12.0;           // of the motion's period: where sampling folds hum onto one of them (a feature a twelfth of the stroke wide has that many),
  double in_step = 0.01;             // and the chance that repetitions which share its phase look as they do is more than this, they do not count either
};

/// screen.h
struct ScreenOptions {
  double share = 0.20;               // of the best score: effects below are not fitted
  double least = 6.0;                // fall of chi2 that a score test must promise
  int most = 8;                      // effects fitted alone, beside instruments
  int forms = 4;                     // of an effect that are fitted
};

/// fit_sets.h
struct FitOptions {
  double look_further = 3.5;         // standard deviations of structure left from which a further effect is looked for
  int kept_most = 14;                // sets that are fitted again when the noise is known; instruments alone in any case
  int pair_parents = 3, triple_parents = 1;  // best sets to which one more effect is added
  int pair_effects = 4, triple_effects = 3;  // most promising effects added to each
  int further_forms = 2;             // forms of an effect that are fitted beside others
};

/// detect.h
struct DetectOptions {
  double p = 0.01;                   // of the windowed maximum, by parametric bootstrap: above it nothing is named
  int repetitions = 2000;            // of the baseline: the chance of 0.0025 is then known to 0.001 (discovery.md: 200)
};

/// localise.h
struct LocaliseOptions {
  int parts = 4;                     // of a record's time, and of the range of an input
  int most_cells = 12;               // that the report tells
};

/// challenge.h
struct ChallengeOptions {
  double judged = 4.0;               // standard deviations of the held-out misfit from which its fall is judged
  int folds = 4;                     // at most, of protocols; those on purpose among them
  double rate_apart = 1.5;           // times slower than the fastest, from which on a trial is of another rate
  double unlearnt = 3.0;             // a protocol that the effect makes this much worse could not teach it, and does not count (of three or more)
};

/// confirm.h: full re-simulation
struct ConfirmOptions {
  int rounds = 6;                    // of the full solver's mapping, and
  double rest = 1e-3;                // of full scale, a change below which it has come to rest: a sixth of what is material
};

/// decide.h
struct DecideOptions {
  double structure = 7.0;            // standard deviations of the residual's block sums that show that something is missing
  double held_out = 0.50;            // share of the misfit that a name must explain on protocols that were not fitted
  double tie = 6.0;                  // rivals nearer than this in BIC are not told apart
  double aside_tie = 3.0;            // the same for a rival that these trials could not show anyway
  double untestable_tie = 24.0;      // tie of a name whose deciding protocol was not run
  double partial_structure = 6.0;    // standard deviations left, and
  double partial_share = 0.04;       // share left, both above: "partial"
  double gain_most = 0.012;          // error of the records' gain (median) that a name may ask for (contract: up to 1 %); beyond it "partial", as is
                                     // a law whose value stands at the end of its range
  double refit = 12.0;               // fall of chi2 a free parameter from which a refit within the prior is a verdict
};

/// describe.h: what is not named
struct DescribeOptions {
  int resamplings = 30;
  double chosen = 1.0 / 3.0;         // of resamplings that choose a term, for it to be told
  int terms = 3;                     // at most in each
};

/// next_experiment.h
struct NextOptions {
  int records = 50;                  // simulated of an experiment, and
  double likely = 0.5;               // the share that must decide for it to be called likely to
};

struct Rules {
  LintOptions lint;
  NoiseOptions noise;
  BaselineOptions baseline;
  CompareOptions compare;
  LineOptions line;
  ScreenOptions screen;
  FitOptions fit;
  DetectOptions detect;
  LocaliseOptions localise;
  ChallengeOptions challenge;
  ConfirmOptions confirm;
  DecideOptions decide;
  DescribeOptions describe;
  NextOptions next;
};

/// tip-hold has no input: its effects are judged in the spectrum. hold_lint.h
struct HoldLintOptions {
  double tremor_sampling = 24.0;     // [Hz], twice 12 Hz
  double pulsation_span = 5.0;       // [s] of the longest record
};

/// hold_screen.h
struct HoldScreenOptions {
  double line_spread = 4.5;          // standard deviations of chi2 by which the strongest line of a band must beat what noise makes of one, and
  double line_gain = 14.0;           // this much more
  double line_share = 0.6;           // of the power about a line that must stand in it: less is a band
  double tremor_gain = 25.0;         // twice the log likelihood that the tremor's band must bring
  double tremor_power = 1.15;        // times the power around
  double tremor_top = 0.8;           // of its power at most in one frequency of each record: more is a line
  double tremor_low = 7.6, tremor_high = 12.4;  // [Hz], where its middle must lie
  double clipped_least = 6.0;        // equal largest samples that are a clipped top, if they are
  double clipped_share = 0.01;       // more than this share, and
  double clipped_times = 4.0;        // more than this many times the samples at the next value
};

/// hold_check.h
struct HoldDetectOptions {
  int repetitions = 500;
};
struct HoldChallengeOptions {
  int samples = 256;                 // of a record, below which half of it is too short to be judged
};

/// hold_decide.h
struct HoldDecideOptions {
  double left_gain = 45.0;           // twice the log likelihood of power that nothing explains,
  double left_power = 1.25;          // times the noise's, if it is material
  double named_share = 0.3;          // of the power that the names must hold beside it
};

struct HoldRules {
  HoldLintOptions lint;
  HoldScreenOptions screen;
  HoldDetectOptions detect;
  HoldChallengeOptions challenge;
  HoldDecideOptions decide;
};
inline constexpr HoldRules kHoldRules;

/// What the stages take as given. Not to be set from outside, but listed with the rest.
namespace assumed {
inline constexpr double kScatterLow = 0.008, kScatterHigh = 0.15;  // within which replicates' scatter is believed
inline constexpr double kScatterAlone = 0.012;   // without replicates; more would hide what differs between protocols
inline constexpr double kGainScatter = 0.006;    // of a record's gain and an instrument's (contract: up to 1 %, evenly: 0.0058)
inline constexpr double kWhiteWorth = 8.0;       // of twice the log likelihood, for a share of noise without memory: once in 200 sets where there is none
inline constexpr double kStatedMost = 1.15;      // times the noise that is stated: what jitter and the converter may add to it
inline constexpr double kMemoryLeast = 0.08;     // correlation of neighbours below which noise is white (its error in a few hundred samples)
inline constexpr double kJitter = 0.05;          // of a step by which a clock may stray (contract: ordinary)
inline constexpr double kWiden = 2.1;            // curvature understates the spread of nonlinear fits whose law is not quite the true one (development half: 90-93 % covered)
inline constexpr double kForm = 0.02;            // relative, 1 sd: gain of the sensor and form of the law, which no fit can see
inline constexpr double kClock = 1e-4;           // relative, 1 sd: rate of a clock, all that a line's frequency owes to the instrument
inline constexpr double kLineWiden = 1.4;        // of an amplitude's interval: a mean of few records
inline constexpr double kFarStart = 4.0;         // amplitudes of a start beyond which a score test is far from it, and
inline constexpr double kFarPromise = 0.7;       // the share of its promise that is believed
inline constexpr double kHumBand = 0.15;         // [Hz] about 50 and 60: what a grid strays in seconds
inline constexpr double kLinePeriods = 2.0;      // in the longest record: less is not told from what is slow
}  // namespace assumed

/// One line of the report's table: reference/discovery.md 4.3 beside what is used.
struct RuleText {
  std::string text, reference;  // reference "-": says nothing of it
  double value;
  std::string why;              // empty: as there
};
std::vector<RuleText> listed(const Rules& rules);
std::vector<RuleText> listed(const HoldRules& rules, const Rules& common);

}  // namespace filum::reconcile
