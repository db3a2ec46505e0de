#pragma once
// What is not named, described: sparse regression of the residual on printable terms.

#include "reconcile/fit.h"

namespace filum::reconcile {

struct Term {
  std::string name;
  double coefficient = 0.0, stability = 0.0;
  std::string output = {};  // whose residual it is a term of
};

struct DescribeSummary {
  std::vector<Term> baseline;  // of the baseline's residual, whatever the verdict (for comparison, see baselines.py)
  std::vector<Term> shape;     // of what the verdict leaves unexplained: residual = sum coefficient * term, in units of full scale
};

/// Terms of every output's residual over every input, its rate, time and products, that are stable over resampling: the output of which most is left first.
std::vector<Term> describe(const RigModel& model, const Fit& fit, const Noise& noise, const DescribeOptions& options = {});

}  // namespace filum::reconcile
