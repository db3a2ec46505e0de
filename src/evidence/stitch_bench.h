#pragma once
// Whole steps while a vessel is stitched: the hands of the demonstration of vessel-stitch, on meshes and sutures of other sizes.
//   seed-vessel        suture of 100 nodes, 168 wall nodes, two instruments; from the first puncture on
//   task-anastomosis   suture of 150 nodes, 1,536 wall nodes in two stumps of three layers with fibres; needle in the tissue, no knot

#include <vector>

#include "evidence/brain_bench.h"

namespace filum {

struct StitchBench {
  const char* name;
  int around, along;    // elements of a stump
  bool layered;         // artery of three layers, pierced easily, instead of the scene's tube
  int suture;           // nodes
  double from, to;      // [s] of the demonstration that are timed
};

std::vector<StitchBench> stitch_benches();
void run_stitch_bench(const StitchBench& bench, BenchResult& r, const StepTimer& timer, const TaskOpener& open_task);

}  // namespace filum
