#pragma once
// The result of a task with a knot: scored once to see whether there is one to test, then again with what its pull test said.

#include "training/task_session.h"
#include "world/world.h"

namespace filum {

/// Scores `task`, whose last observation is of the present state of `world`. A finished task's knot is pulled (world/pull_test.h).
/// Deterministic, so a replay of the same steps gives the same figures.
Result finish_with_security(const TaskSession& task, const World& world);

}  // namespace filum
