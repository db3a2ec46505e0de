#pragma once
// Stage challenge: predictions of what was not fitted. Folds are whole protocols, never samples of one record: what was marked hold_out; else, on purpose,
// the fastest rate (fit slow, validate fast) and the rarest size (fit one size, validate another) where there are several, and of the rest each protocol in
// turn (leave-one-group-out; Hastie, Tibshirani & Friedman 2009, ch. 7.10).

#include "reconcile/candidates.h"

namespace filum::reconcile {

struct Gap {
  double before = 0.0, after = 0.0;  // rms residual over the noise's standard deviation
};
Gap gap_of(const Noise& noise, const Fit& before, const Fit& after);

/// Which trials a fold holds out, and by what.
struct Part {
  std::string held;
  std::vector<bool> trials;
  bool counts = true;  // in the held-out gap and in the criterion
};
/// The folds of a dataset. Trials marked hold_out are a fold of their own, which alone counts, and stand in no other.
std::vector<Part> parts_of(const Dataset& d, const ChallengeOptions& options);
/// How fast a trial's own input goes [unit of the input / s, or of `speed` where that is recorded]: nine tenths of its steps are slower.
double rate_of(const Dataset& d, const Trial& t);

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

struct ChallengeSummary {
  bool done = false;
  double explained = 1.0;  // share of the held-out misfit that goes
  Gap gap;                 // NaN where nothing is held out
  std::string how;
  std::vector<Fold> folds;
  Fit before, after;       // predictions of the trials marked hold_out; empty without them
};
/// Fits baseline and named set to the rest of every fold and lets them predict it; only the records' own scales are fitted there. null: nothing is named.
ChallengeSummary challenge(const Candidates& sets, const Fit* named, const ChallengeOptions& options, const Run& run);

}  // namespace filum::reconcile
