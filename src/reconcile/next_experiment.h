#pragma once
// Stage next experiment: over a menu of protocols of the rig, the one that best separates the sets that the trials so far do not tell apart.

#include <optional>

#include "reconcile/fit.h"

namespace filum::reconcile {

struct NextSummary {
  std::string protocol, why;
  double chance = 0.0;  // of telling the rivals apart, of the simulated repetitions
};

/// `evidence`: BIC of each rival (less is better); `tie`: by how much one must lead.
std::optional<NextSummary> next_experiment(const Fitter& fitter, const std::vector<const Fit*>& rivals, const std::vector<double>& evidence, double dispersion, double tie, const NextOptions& options = {});

}  // namespace filum::reconcile
