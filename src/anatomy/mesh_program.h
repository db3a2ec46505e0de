#pragma once
// filum mesh: a brain region from a head scan, for models/brain/*.yaml or `filum run TASK --model`. A function, so that tests can call
// it as a user does.

#include <cstdio>

namespace filum {

/// Words as on the command line, the first the program's name. Returns 0 done, 1 failed, 2 bad input, which is said on `err`.
int mesh_program(int argc, const char* const* argv, std::FILE* out = stdout, std::FILE* err = stderr);

}  // namespace filum
