#pragma once
// Fingerprints of a State: of each array by name, and of all together, for bit-equal replay.

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "world/state.h"

namespace filum {

std::uint64_t hash_state(const State& s) noexcept;

/// In a fixed order: "positions", "velocities", "theta", ..., "instruments", "flags".
std::vector<std::pair<std::string, std::uint64_t>> array_hashes(const State& s);

}  // namespace filum
