#pragma once
// Whole steps while a vessel is stitched: the hands of the demonstration of vessel-stitch, on meshes and sutures of other sizes.
//   seed-vessel        suture of 100 nodes, 168 wall nodes, two instruments; from the first puncture on
//   task-anastomosis   suture of 150 nodes, 1,536 wall nodes in two stumps of three layers with fibres; needle in the tissue, no knot
//   task-anastomosis-8 the same stumps after eight stitches that are laid by construction (sewn_bench.h), while the hands set a ninth

#include <vector>

#include "evidence/brain_bench.h"

namespace filum {

struct StitchBench {
  const char* name;
  int around, along;    // elements of a stump
  bool layered;         // artery of three layers, pierced easily, instead of the scene's tube
  int suture;           // nodes
  double from, to;      // [s] of the demonstration that are timed
  int sewn;             // stitches there before the hands begin
};

std::vector<StitchBench> stitch_benches();
void run_stitch_bench(const StitchBench& bench, BenchResult& r, const StepTimer& timer, const TaskOpener& open_task);

}  // namespace filum
