#pragma once
// Writes a session to disk as it happens. The caller's threads only push into lock-free queues; a thread of
// the recorder's own commits what came in every 20 ms, so that after a kill at any moment all but the last
// 100 ms can be read back. It asks for real-time priority; where that is refused and more processes work than there
// are cores, the system may let it wait, and more than 100 ms may be lost to a kill. The file is one SQLite database in WAL mode while it is open, and a single plain
// file after close().

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "session/records.h"

namespace filum {

inline constexpr int kRecordingFormat = 2;  // 1: events without text; still read

struct RecorderOptions {
  std::string file;                        // created; an existing file is refused
  RecordingMeta meta;                      // format and started_utc are filled in if empty
  std::vector<SourceFile> sources;         // everything a replay needs besides the program
  std::chrono::milliseconds interval{20};  // between commits
  std::size_t step_capacity = 4096;        // records the queues hold while the disk stalls
  std::size_t sample_capacity = 32768;
  std::size_t event_capacity = 4096;
  std::size_t array_hash_capacity = 4096;
};

/// How the recording is doing, for the screen. A trainee must never believe in a recording that does not
/// happen.
struct RecorderStatus {
  bool healthy = true;  // the last write went through and nothing was lost
  std::string message;  // what is wrong and what to do; empty when healthy
  std::uint64_t steps_stored = 0;
  std::uint64_t samples_stored = 0;
  std::uint64_t records_lost = 0;  // queue full: counted here and stored as event "recording-lost"
};

class Recorder {
 public:
  /// Creates the file, stores meta and sources and makes the first commit of its thread. Throws InputError when the folder is missing, read-only or
  /// full, when the file exists, or when the participant code is not allowed.
  explicit Recorder(RecorderOptions options);
  /// close()
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  // Each by one thread of its own choice (a queue for each kind of record). None blocks, allocates or throws;
  // false: queue full, counted.
  bool record_step(const StepRecord& record) noexcept;
  bool record_event(const EventRecord& record) noexcept;
  bool record_array_hash(const ArrayHashRecord& record) noexcept;

  /// Called by one thread, the one that polls the devices. Never blocks, allocates or throws; false: queue
  /// full, counted.
  bool record_sample(const SampleRecord& record) noexcept;

  // Any thread; these lock and may allocate.
  void set_score(const ScoreRecord& score);
  RecorderStatus status() const;

  /// Stores what is left, marks the recording finished and folds the journal into the one file. Safe to call
  /// twice. Returns false (and says why in status()) if something could not be stored.
  bool close();

  const std::string& file() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Now, as "2026-11-21T09:30:00Z".
std::string utc_now();

}  // namespace filum
