#pragma once
// Benches of the brain, to stand in the list of bench.cpp.

#include <functional>
#include <utility>
#include <vector>

#include "evidence/bench.h"

namespace filum {

/// Times a step again and again; what follows it is not timed.
using StepTimer = std::function<void(BenchResult&, const std::function<void()>& step, const std::function<void()>& look)>;
using TimedBench = std::function<void(BenchResult&, const StepTimer&)>;

std::vector<std::pair<BenchResult, TimedBench>> brain_benches();

/// The block of brain-10800 under its blade: each call is a step of 10 ms.
std::function<void()> pressed_block();

}  // namespace filum
