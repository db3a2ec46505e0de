#pragma once
// The whole program as a function, so that tests can call it as a user does.

#include "cli/options.h"

namespace filum {

/// Reads which subcommand is wanted and runs it. Returns an ExitCode; what is wrong is said on io.err, nothing is thrown.
int program(int argc, const char* const* argv, const Streams& io = {});

}  // namespace filum
