#pragma once
// What a reconciliation found; written as report.json (contract), report.html and model.yaml.

#include <optional>

#include "reconcile/baseline.h"
#include "reconcile/dataset.h"
#include "reconcile/fit.h"
#include "reconcile/numerics.h"
#include "reconcile/rules.h"
#include "reconcile/screen.h"

namespace filum::reconcile {

struct Estimate {
  std::string name, unit;
  double value = 0.0, low = 0.0, high = 0.0;  // [SI], 95 %
};

struct NamedEffect {
  Effect effect;
  std::string form;
  std::vector<Estimate> parameters;
};

/// One set of effects that was fitted, with why it was not taken.
struct Tried {
  std::vector<Effect> effects;
  std::string form;
  double evidence = 0.0;   // BIC less that of the baseline: the lower the better
  double explained = 0.0;  // share of what the baseline leaves
  bool taken = false;
  std::string why;
};

/// What the score test said of an effect, and what came of it.
struct Screened {
  Effect effect;
  std::string form;        // that of the best start
  double gain = 0.0;       // fall of chi2 that it promises, against the noise as measured; NaN: a line, judged in the spectrum
  double masked = 0.0;     // share of its signature that a refit of the baseline hides
  std::string what;        // fitted, or why not
};

struct Cell {
  std::string trial, phase, range;
  double share = 0.0;
};

/// One bin of one axis (trial, output, phase, strain or input, rate, cycle, frequency): its part of what lies beyond the noise, and by how many standard
/// deviations of noise alone it does.
struct Share {
  std::string axis, bin;
  double share = 0.0, deviations = 0.0;
};

struct Gap {
  double before = 0.0, after = 0.0;  // rms residual over the noise's standard deviation
};

/// Trials that were held out together, and what was left of them.
struct Fold {
  std::string held;                 // by what
  std::vector<std::string> trials;  // files
  Gap gap;
  double before = 0.0, after = 0.0; // chi2 over the overdispersion, less the samples
  int samples = 0;
  bool counts = true;               // in the held-out gap and criterion;
  std::string why;                  // else why not
};

struct NextExperiment {
  std::string protocol, why;
  double chance = 0.0;  // of telling the rivals apart, of 50 simulated repetitions
};

struct Term {
  std::string name;
  double coefficient = 0.0, stability = 0.0;
  std::string output = {};  // whose residual it is a term of
};

/// What the trainer's own solver says of a name (confirm.h).
struct Confirmation {
  std::string solver;
  bool ran = false, holds = false;
  double difference = 0.0, mesh = 0.0;          // of full scale: full against reduced model; full against itself at half the step
  double evidence = 0.0;                        // BIC less that of the baseline, both by the full solver
  double share = 0.0;                           // of the fall of chi2 that the reduced model promised
  double material = 0.0;                        // change of the prediction over the materiality
  double chi2_before = 0.0, chi2_after = 0.0;   // a sample
  std::vector<NamedEffect> values;              // refitted
};

/// Whether the baseline's residual is one that noise makes: the statistic against simulated repetitions of the baseline.
struct Detection {
  double statistic = 0.0;   // largest whitened sum over any window, over all records
  double score = 0.0;       // best score test of the catalogue: fall of chi2
  std::string score_is = "best score test of the catalogue";
  double p = 1.0;           // of the rarer of the two among the repetitions, (1 + k)/(1 + B), doubled
  int repetitions = 0;
  std::vector<double> null_scores;  // best score test of each repetition, ascending
  double chance = 1.0;      // that where nothing is missing some effect does as well as the best one here
  double excess = 0.0;      // of full scale: rms of what is beyond the noise
  std::string trial;
  double from = 0.0, to = 0.0;  // [s], the window
};

struct Result {
  std::string verdict;  // agree, parameter, effect, ambiguous, unknown
  std::string sentence; // the verdict in words and what would change it
  bool partial = false;
  std::vector<NamedEffect> effects;
  std::vector<Estimate> baseline, baseline_alone;
  std::vector<Tried> rivals, tried;
  Noise noise;
  Gap fit, held_out;
  std::string held_out_how;
  std::vector<Fold> folds;
  std::vector<Cell> where;
  std::vector<Share> where_by;
  std::vector<Screened> screened;   // every effect of the rig by the score test of the baseline's residual
  std::vector<NotTestable> not_testable;
  std::optional<NextExperiment> next;
  std::optional<Confirmation> confirmation;
  std::optional<Detection> detection;
  BaselineSummary starts;           // of the baseline; empty where nothing is free
  Numerics numerics;                // solver error and sensitivities of the fit that the verdict rests on
  std::vector<Term> shape;          // of an unknown effect: residual = sum coefficient * term, in units of full scale
  std::vector<Term> residual_terms; // the same of the baseline's residual, whatever the verdict (for comparison, see baselines.py)
  double dispersion = 1.0, structure_before = 0.0, structure_after = 0.0;
  std::vector<std::vector<Effect>> alike_sets;  // sets that the data do not tell apart, the best first, and
  Likeness alike;                   // how alike their signatures are
  Fit before, after;                // for the plots
  Fit held_before, held_after;      // the same of trials marked hold_out; empty without them
  std::vector<Form> forms;          // owned here, since fits point to them
  Rules rules;
  double seconds = 0.0;
};

struct Options {
  Rules rules;
  int threads = 2;
  std::function<void(const std::string& stage, double share)> progress;  // may be empty; by any thread, one at a time, share never falls
  std::function<bool()> cancelled;                                       // may be empty; asked before every fit, by any thread
};

/// Thrown by reconcile() when it was cancelled.
struct Cancelled {};
void stop_if_cancelled(const Options& options);

Result reconcile(const Dataset& d, const Options& options = {});
/// tip-hold has no input: its effects are told apart in the spectrum.
Result reconcile_hold(const Dataset& d, const RigModel& model, const Options& options);

// Parts, each usable alone.
std::vector<Cell> localise(const RigModel& model, const Fit& base, const Noise& noise);
/// The same axis by axis: trial, output, phase, strain (or the input), rate, cycle, band of frequency. Axes on which there is one bin only are left out.
std::vector<Share> localise_by(const RigModel& model, const Fit& base, const Noise& noise);
Gap gap_of(const Noise& noise, const Fit& before, const Fit& after);
/// Terms of every output's residual over every input, its rate, time and products, that are stable over resampling: the output of which most is left first.
std::vector<Term> describe(const RigModel& model, const Fit& fit, const Noise& noise);
/// `evidence`: BIC of each rival (less is better); `tie`: by how much one must lead.
std::optional<NextExperiment> next_experiment(const Fitter& fitter, const std::vector<const Fit*>& rivals, const std::vector<double>& evidence, double dispersion, double tie);
std::vector<Estimate> baseline_estimates(const Fitter& fitter, const Fit& fit, double dispersion);
std::vector<NamedEffect> effect_estimates(const Fitter& fitter, const Fit& fit, double dispersion);
/// An interval reaches to the values that other forms give which the data do not tell apart: which form is true is part of what is not known.
void widen_by_forms(std::vector<NamedEffect>& effects, const std::vector<NamedEffect>& others);

}  // namespace filum::reconcile
