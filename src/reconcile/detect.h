#pragma once
// Stage detect: whether the baseline's residual is one that noise makes. Runs after the fits, since what no set of effects takes away counts as noise.

#include "reconcile/candidates.h"

namespace filum::reconcile {

/// The statistic against simulated repetitions of the baseline.
struct DetectSummary {
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

DetectSummary detect(const Candidates& sets, const DetectOptions& options);

}  // namespace filum::reconcile
