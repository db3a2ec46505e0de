#pragma once
// What a step costs after 1, 2, 4 and 8 stitches: the stumps of vessel-stitch sewn over and over by one thread that is laid through the
// wall by construction (tracks of three points through each edge), not by hands; needle and instruments rest. The thread settles for half
// a second before steps are timed. No knots: what is counted is thread in tissue and thread on tissue. Test: bench_test.

#include <utility>
#include <vector>

#include "evidence/brain_bench.h"
#include "world/model.h"
#include "world/state.h"

namespace filum {

/// Model with a longer thread, and its state with the thread in the wall; bites go through this row of elements from the cut edge.
std::pair<std::shared_ptr<const Model>, State> sewn_stumps(const std::shared_ptr<const Model>& of, int stitches, int row = 2);

inline constexpr int kSewn[] = {1, 2, 4, 8};
void run_sewn_bench(int stitches, BenchResult& r, const StepTimer& timer, const TaskOpener& open_task);

}  // namespace filum
