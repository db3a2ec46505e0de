#pragma once
// Stability of an equilibrium of a rod: is its elastic energy a minimum with some coordinates held?

#include <functional>

#include "evidence/rod_probe.h"

namespace filum {

/// True if the second derivative of the elastic energy of `s`, held as in `held`, is positive definite.
bool is_stable(const RodMaterial& m, const RodState& s, const Eigen::Array<bool, 4, Eigen::Dynamic>& held);

/// Largest load below `high` for which `stable` holds, by bisection; `stable(low)` must hold and
/// `stable(high)` must not, else NaN.
double critical_load(double low, double high, const std::function<bool(double)>& stable);

}  // namespace filum
