#pragma once
// A task with the hands of its demonstration, to be stepped by whoever times it. Test: tests/cli/driven_task_test.cpp.

#include <string>

#include "evidence/bench.h"

namespace filum {

/// Throws InputError for a task that is not there or has no demonstration.
DrivenTask driven_task(const std::string& root, const std::string& task);

}  // namespace filum
