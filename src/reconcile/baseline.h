#pragma once
// Stage baseline: the model under test alone, from several starts: the model under test may have a second optimum (a thread bent far, a prior that ends near the values), and
// an effect must not be named for a baseline that merely stopped short (multi-start: Rinnooy Kan & Timmer, Math. Prog. 39:27, 1987).

#include "reconcile/estimate.h"
#include "reconcile/measure_noise.h"
#include "reconcile/run.h"

namespace filum::reconcile {

struct BaselineStart {
  std::vector<double> from, to;  // [SI], all baseline parameters
  double chi2 = 0.0;
  bool same = false;             // ended where the best one did
};

struct BaselineSummary {
  std::vector<BaselineStart> starts;  // empty where nothing is free
  Fit fit;                            // under the noise as the best start left it
  std::vector<Estimate> alone;        // its values, when all fits are done
  int same() const;                   // starts at the best optimum
};

/// Values from which the fits start: the guess first. Ratios (Poisson's) start at themselves and at a quarter and three quarters of their range.
std::vector<std::vector<double>> baseline_starts(const Fitter& fitter, const std::vector<double>& guess, const BaselineOptions& options);
/// The best of the fits from all starts. `warm`, where it is given, is one from the guess whose scales of the records are kept for the first start.
Fit best_start(const Fitter& fitter, const std::vector<double>& guess, const Fit* warm, int threads, const BaselineOptions& options, BaselineSummary& summary);
/// The stage: best start, noise and the records' scatter from what it leaves (both set in `fitter`), and the fit under these.
BaselineSummary fit_baseline(Fitter& fitter, const NoiseSummary& noise, const BaselineOptions& options, const Run& run);

}  // namespace filum::reconcile
