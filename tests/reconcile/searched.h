#pragma once
// The stages from noise to fit, for tests of what comes after them.

#include "reconcile/result.h"

namespace filum::reconcile {

inline Candidates searched(const RigModel& model, const std::vector<Form>& forms, const Options& options) {
  Fitter fitter(model, {});
  const NoiseSummary noise = measure_noise(fitter, options.rules.noise);
  const BaselineSummary baseline = fit_baseline(fitter, noise, options.rules.baseline, options);
  Candidates sets(fitter, baseline.fit, forms, options.rules.compare, options.rules.line);
  fit_sets(sets, screen(sets, options.rules.screen), options.rules.fit, options.rules.screen, options);
  return sets;
}

}  // namespace filum::reconcile
