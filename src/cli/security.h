#pragma once
// The result of a task whose work is tested afterwards: a knot by pulling, a vessel by letting blood in.

#include <functional>

#include "training/task_session.h"
#include "world/world.h"

namespace filum {

/// Scores `task`, whose last observation is of the present state of `world`. A finished task's knot is pulled (world/pull_test.h), the
/// clamps of a vessel come off (world/join_test.h).
/// Deterministic, so a replay of the same steps gives the same figures. Takes some seconds: `go_on` is told how much is done, 0 to 1, and
/// may return false to leave the knot unpulled.
Result finish_with_security(const TaskSession& task, const World& world, const std::function<bool(double)>& go_on = {});

/// True if `result`, of task.finish(), has a knot to pull.
bool has_knot_to_pull(const TaskSession& task, const World& world, const Result& result);

}  // namespace filum
