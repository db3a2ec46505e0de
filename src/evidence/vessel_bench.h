#pragma once
// Timings of the vessel wall by itself: steps of two stumps that are handled, and how they grow with the mesh.

#include <utility>
#include <vector>

#include "evidence/brain_bench.h"
#include "physics/vessel_wall_element.h"

namespace filum {

/// Layers of a rat femoral artery (models/vessel/rat-femoral-artery.yaml).
std::vector<WallLayer> bench_artery();
std::vector<std::pair<BenchResult, TimedBench>> vessel_benches();

}  // namespace filum
