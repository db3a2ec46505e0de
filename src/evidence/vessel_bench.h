#pragma once
// Timings of the vessel wall by itself: steps of two stumps that are handled, and how they grow with the mesh.

#include <utility>
#include <vector>

#include "evidence/brain_bench.h"

namespace filum {

std::vector<std::pair<BenchResult, TimedBench>> vessel_benches();

}  // namespace filum
