#pragma once
// The baseline alone, from several starts: the model under test may have a second optimum (a thread bent far, a prior that ends near the values), and an
// effect must not be named for a baseline that merely stopped short (multi-start: Rinnooy Kan & Timmer, Math. Prog. 39:27, 1987).

#include "reconcile/fit.h"

namespace filum::reconcile {

struct BaselineOptions {
  double factor = 5.0;   // scale parameters start at 1/factor, 1 and factor times the first guess, within their bounds
  double same = 1.0;     // chi2 above the best, up to which a start ended at the same optimum, or
  double share = 1e-3;   // this share of the best chi2 if that is more (a baseline that misfits stops at 1e-5 of it)
};

struct BaselineStart {
  std::vector<double> from, to;  // [SI], all baseline parameters
  double chi2 = 0.0;
  bool same = false;             // ended where the best one did
};

struct BaselineSummary {
  std::vector<BaselineStart> starts;  // empty where nothing is free
  int same() const;                   // of them at the best optimum
};

/// Values from which the fits start: the guess first. Ratios (Poisson's) start at themselves and at a quarter and three quarters of their range.
std::vector<std::vector<double>> baseline_starts(const Fitter& fitter, const std::vector<double>& guess, const BaselineOptions& options);
/// The best of the fits from all starts. `warm`, where it is given, is one from the guess whose scales of the records are kept for the first start.
Fit fit_baseline(const Fitter& fitter, const std::vector<double>& guess, const Fit* warm, int threads, const BaselineOptions& options, BaselineSummary& summary);

}  // namespace filum::reconcile
