#pragma once
// A result as JSON text, with the keys that shared/cli.md and the viewer's message schema fix.

#include <string>

#include "training/result.h"

namespace filum {

/// Keys "task", "title", "finished", "passed", "seconds", "score", "knot", "events", "series", "paths";
/// `full` adds "verdict", "measures" and "knot_report". Numbers that are not finite become null. One line.
std::string result_json(const Result& result, bool full = true);

}  // namespace filum
