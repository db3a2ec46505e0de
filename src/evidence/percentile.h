#pragma once

#include <algorithm>
#include <vector>

#include "base/numbers.h"

namespace filum {

/// NaN of nothing.
inline double percentile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values.empty() ? kNaN : values[std::min(values.size() - 1, static_cast<std::size_t>(share * static_cast<double>(values.size())))];
}

/// The upper one of the two in the middle; NaN of nothing.
inline double median(const std::vector<double>& values) { return percentile(values, 0.5); }

}  // namespace filum
