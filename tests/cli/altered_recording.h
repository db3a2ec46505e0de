#pragma once
// A recording in which one step claims another state than the one that came out.

#include <gtest/gtest.h>

#include <string>

#include "cli/session_files.h"

namespace filum {

inline constexpr std::uint64_t kAlteredStep = 100;

inline void write_altered(const std::string& from, const std::string& to) {
  const RecordingReader original(from);
  const RecordedSetup recorded(original);
  const auto recorder = make_recorder(to, recorded.setup(), "demonstrator");
  StepRecord record;
  for (auto steps = original.steps(); steps.next(record);) {
    if (record.step == kAlteredStep) record.state_hash ^= 1;
    ASSERT_TRUE(recorder->record_step(record));
  }
  ASSERT_TRUE(recorder->close());
}

}  // namespace filum
