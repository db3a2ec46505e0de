#pragma once
// What a device reports while its tool stands still in a vice: the floor that tremor has to stand out of. A script has no sensor: what
// it says is exact, and its floor is zero. Test: study_test, report_test.

#include <optional>
#include <string>
#include <vector>

#include "analysis/recorded_series.h"

namespace filum {

struct NoiseFloor {
  std::optional<EvenPath> path;
  std::string source;  // for people: which recording, or why there is none
};

/// `clamped` may be null; `path` is the one that is judged.
NoiseFloor noise_floor(const RecordedSession& session, const RecordedSession* clamped, int tool, bool hand, const EvenPath& path);

/// Among recordings with the tool clamped the one by the same device, or null: another device's floor says nothing.
const RecordedSession* clamped_like(const RecordedSession& session, const std::vector<RecordedSession>& clamped);

}  // namespace filum
