#pragma once
// What steps take that nothing interrupts: others on the machine, and its host, lengthen some steps of every run, but hardly the same one in
// each. So the same steps (the same bits) are run several times, and the least time of each counts. Test: undisturbed_test.

#include <algorithm>
#include <vector>

#include "evidence/percentile.h"

namespace filum {

struct Undisturbed {
  int passes = 0;  // 0: not taken
  double p50_ms = 0.0, p99_ms = 0.0, max_ms = 0.0;
};

/// `passes`: [ms] of every step, in each of them; steps that not all have do not count.
inline Undisturbed undisturbed(const std::vector<std::vector<double>>& passes) {
  if (passes.empty()) return {};
  std::vector<double> least = passes.front();
  for (const std::vector<double>& pass : passes) {
    least.resize(std::min(least.size(), pass.size()));
    for (std::size_t i = 0; i < least.size(); ++i) least[i] = std::min(least[i], pass[i]);
  }
  return {static_cast<int>(passes.size()), percentile(least, 0.5), percentile(least, 0.99), percentile(least, 1.0)};
}

}  // namespace filum
