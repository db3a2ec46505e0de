#pragma once
// Predictions of what was not fitted. Folds are whole protocols, never samples of one record: what was marked hold_out; else, on purpose, the fastest
// rate (fit slow, validate fast) and the rarest size (fit one size, validate another) where there are several, and of the rest each protocol in turn
// (leave-one-group-out; Hastie, Tibshirani & Friedman 2009, ch. 7.10).

#include "reconcile/result.h"
#include "reconcile/search.h"

namespace filum::reconcile {

/// Which trials a fold holds out, and by what.
struct Part {
  std::string held;
  std::vector<bool> trials;
  bool counts = true;  // in the held-out gap and in the criterion
};
/// The folds of a dataset. Trials marked hold_out are a fold of their own, which alone counts, and stand in no other.
std::vector<Part> parts_of(const Dataset& d, const Rules& rules);
/// How fast a trial's own input goes [unit of the input / s, or of `speed` where that is recorded]: nine tenths of its steps are slower.
double rate_of(const Dataset& d, const Trial& t);

/// Adds the squares of the residuals in units of the noise, and how many they are.
void add_squares(const Noise& noise, const Fit& f, double& sum, int& n);

struct Challenge {
  bool done = false;
  double explained = 1.0;  // share of the held-out misfit that goes
  Gap gap;
  std::string how;
  std::vector<Fold> folds;
  Fit before, after;       // predictions of the trials marked hold_out
};
/// Fits both to the rest of every fold and lets them predict it; only the records' own scales are fitted there.
Challenge challenge(const Search& search, const Fit& base, const Fit& named, const Options& options);

}  // namespace filum::reconcile
