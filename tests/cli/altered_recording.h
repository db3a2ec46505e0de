#pragma once
// Recordings in which something is other than it was: a step that claims another state, a byte of the file.

#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "cli/session_files.h"

namespace filum {

inline constexpr std::uint64_t kAlteredStep = 100;

/// The steps of `from`, the one of number `altered` with another hash, and one event.
inline void write_altered(const std::string& from, const std::string& to, std::uint64_t altered = kAlteredStep) {
  const RecordingReader original(from);
  const RecordedSetup recorded(original);
  const auto recorder = make_recorder(to, recorded.setup(), "demonstrator");
  StepRecord record;
  for (auto steps = original.steps(); steps.next(record);) {
    if (record.step == altered) record.state_hash ^= 1;
    ASSERT_TRUE(recorder->record_step(record));
  }
  ASSERT_TRUE(recorder->record_event({1, 0.002, "planted-event", -1, 0.0, "-", "in words"}));
  ASSERT_TRUE(recorder->close());
}

/// A copy in which the first `text` found begins with another letter.
inline void damage(const std::string& from, const std::string& text, const std::string& to) {
  std::string bytes;
  {
    std::ifstream in(from, std::ios::binary);
    bytes.assign(std::istreambuf_iterator<char>(in), {});
  }
  const std::size_t at = bytes.find(text);
  ASSERT_NE(at, std::string::npos) << text;
  bytes[at] = static_cast<char>(bytes[at] ^ 1);
  std::ofstream(to, std::ios::binary) << bytes;
}

}  // namespace filum
