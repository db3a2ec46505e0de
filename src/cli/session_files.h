#pragma once
// Between sessions on disk and sessions in memory: recorders for runs, worlds for recordings, scores of recordings.

#include <cstdio>
#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "analysis/recorded_series.h"
#include "cli/setup.h"
#include "session/recorder.h"
#include "session/recording_reader.h"
#include "session/replay.h"
#include "training/result.h"

namespace filum {

/// A recorder that stores the session's meta data and all files it was made from. Throws InputError.
std::unique_ptr<Recorder> make_recorder(const std::string& file, const Setup& setup, const std::string& input,
                                        const std::string& participant = "", const std::string& calibration = "");

/// The scene and the rules a recording was made with, from the files stored in it. Throws InputError, where they are damaged naming
/// the damage. The folder with these files lives as long
/// as this object.
class RecordedSetup {
 public:
  explicit RecordedSetup(const RecordingReader& recording);
  ~RecordedSetup();
  RecordedSetup(const RecordedSetup&) = delete;
  RecordedSetup& operator=(const RecordedSetup&) = delete;
  const Setup& setup() const { return setup_; }

 private:
  std::string folder_;
  Setup setup_;
};

/// Under which a session was made, as its recording tells.
struct Conditions {
  std::string input;       // pointer, demo, device; empty: not known
  bool exam = false;       // without guides, hints and overlays
  double stiffness = 1.0;  // of the brain, times the model's
};
Conditions read_conditions(const RecordingReader& recording);

struct Rescored {
  Result result;
  ReplayResult replay;
};

/// A recording ready for analysis; where no device measured the squeeze, that of the simulation, replayed.
RecordedSession open_session(const std::string& file);

/// Throws InputError for a recording without a step: there is nothing to replay.
void require_steps(const RecordingReader& recording);

/// Names what is damaged on `err`, a line for each place. Exit code: kBadInput where anything is, else `code`.
int tell_damage(std::FILE* err, const std::string& file, const std::vector<std::string>& damage, int code);

/// Replays a recording to its end, or to where it is damaged, and scores it anew.
Rescored rescore(const RecordingReader& recording);

/// The keys that `run` and `score` share: result_json() without the curves.
nlohmann::ordered_json result_document(const Result& result);

/// The viewer's `result` message.
std::string result_message(const Result& result, const std::string& session);
/// The same from the JSON that a recording stores; empty if that is no result.
std::string result_message(const std::string& stored_json, const std::string& session);

}  // namespace filum
