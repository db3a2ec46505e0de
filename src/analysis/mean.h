#pragma once

#include <numeric>
#include <vector>

namespace filum {

inline double mean_of(const std::vector<double>& x) { return std::accumulate(x.begin(), x.end(), 0.0) / static_cast<double>(x.size()); }

}  // namespace filum
