#pragma once
// What a trainer is started with, tried before anybody waits for it. Tests: tests/cli/trainer_check_test.cpp, train_test.cpp.

#include "cli/trainer.h"

namespace filum {

/// Throws InputError for a root without tasks, a model that no task can take, a folder that holds no viewer, devices that cannot be
/// opened and a calibration that cannot be read. An empty viewer folder serves none.
void check_trainer_options(const TrainerOptions& options);

}  // namespace filum
