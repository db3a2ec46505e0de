#pragma once
// The recording file from the writing side: one SQLite database, records in blocks with a checksum each.
// Private to session.

#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "session/records.h"

namespace filum {

class BlockWriter {
 public:
  /// Creates `file` with its tables, meta and sources, then switches to WAL. Throws InputError; leaves no
  /// file behind then.
  BlockWriter(const std::string& file, const RecordingMeta& meta, const std::vector<SourceFile>& sources);
  ~BlockWriter();

  /// The first commit into the fresh log, which syncs its header: done before records come it delays none. Throws
  /// InputError; leaves no file behind then, and nothing but the destructor may follow.
  void begin();

  struct Batch {
    const std::vector<StepRecord>& steps;
    const std::vector<SampleRecord>& samples;
    const std::vector<EventRecord>& events;
    const std::vector<ArrayHashRecord>& array_hashes;
    const std::optional<ScoreRecord>& score;
  };
  /// All of the batch in one transaction, or none of it (throws soci::soci_error).
  void commit(const Batch& batch);

  /// Marks the recording finished and folds the journal into the file.
  void finish();

 private:
  [[noreturn]] void give_up(const std::string& file, const std::exception& error);

  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace filum
