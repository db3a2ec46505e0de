#pragma once
// A quick real session for tests of what follows it: half a second of a laboratory task by its demonstration, recorded or not.

#include <memory>

#include "cli/live_session.h"
#include "cli/session_files.h"

namespace filum {

inline std::unique_ptr<LiveSession> started_session(Recorder* recorder, const char* task = "tip-hold") {
  LiveOptions options;
  options.paced = false;
  options.longest = 0.5;
  options.recorder = recorder;
  auto session = std::make_unique<LiveSession>(load_setup(FILUM_SOURCE_DIR, task), open_inputs("demo", FILUM_SOURCE_DIR, task), std::move(options));
  session->start();
  return session;
}

}  // namespace filum
