#pragma once
// Values with their 95 % intervals, from the curvature at the optimum of a fit.

#include "reconcile/fit.h"

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

std::vector<Estimate> baseline_estimates(const Fitter& fitter, const Fit& fit, double dispersion);
std::vector<NamedEffect> effect_estimates(const Fitter& fitter, const Fit& fit, double dispersion);
/// An interval reaches to the values that other forms give which the data do not tell apart: which form is true is part of what is not known.
void widen_by_forms(std::vector<NamedEffect>& effects, const std::vector<NamedEffect>& others);

}  // namespace filum::reconcile
