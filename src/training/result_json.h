#pragma once
// A result as JSON text, with the keys that shared/cli.md and the viewer's message schema fix.

#include <string>

#include "training/result.h"

namespace filum {

/// Keys "task", "title", "finished", "passed", "seconds", "score", "knot", "events", "series", "paths", "verdict";
/// "knot" is null where the task has none. `full` adds "measures" and "knot_report" of a knot. Scores and measures that are not finite
/// become null, such samples of curves and paths are left out. One line.
std::string result_json(const Result& result, bool full = true);

}  // namespace filum
