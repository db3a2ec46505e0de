#pragma once
// Steps a world through the inputs of a recording and compares the state hash of every step.

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "session/recording_reader.h"
#include "world/world.h"

namespace filum {

struct ReplayDifference {
  std::uint64_t step = 0;
  std::string
      array;  // the first array of the state that differs, as far as the recording tells; else "state"
};

struct ReplayResult {
  bool identical = false;
  std::uint64_t steps = 0;  // compared
  std::optional<ReplayDifference> first_difference;
  std::string damage;  // why the steps could not be read to their end; empty: they could
};

/// `world` is fresh from load_model on the recording's sources. `on_step` sees every step as it is replayed
/// (scores, exports, the scrubber). Stops at the first difference unless `to_the_end`, and at a damaged block of
/// steps. Throws InputError if the recording has a gap in its steps.
ReplayResult replay(const RecordingReader& recording, World& world,
                    const std::function<void(const StepRecord&, const Observation&)>& on_step = {},
                    bool to_the_end = false);

}  // namespace filum
