#pragma once
// Reads a recording, finished or cut off by a crash. Every checksum is compared; whatever is wrong with the
// file becomes an InputError that names it: not a recording, made by a newer program, cut short, damaged.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "session/records.h"

namespace filum {

namespace detail {
class RecordingFile;
}

/// One kind of record in the order it was stored. next() throws InputError at the first damaged block.
template <class Record>
class RecordCursor {
 public:
  /// False at the end.
  bool next(Record& record);

 private:
  friend class RecordingReader;
  explicit RecordCursor(std::shared_ptr<detail::RecordingFile> file) : file_(std::move(file)) {}
  std::shared_ptr<detail::RecordingFile> file_;
  std::vector<Record> block_;
  std::size_t at_ = 0;
  long long block_id_ = 0;
};

class RecordingReader {
 public:
  /// Throws InputError when the file is no recording this program can read. Never writes beside a file in a
  /// folder that is read-only: a crashed recording there is copied to a temporary folder first.
  explicit RecordingReader(const std::string& file);

  const std::string& file() const;
  const RecordingMeta& meta() const;
  /// False: the program ended before close(); the records are good up to the last commit.
  bool finished() const;
  const std::vector<SourceFile>& sources() const;
  const std::optional<ScoreRecord>& score() const;

  // Cursors are independent of each other; all of one reader belong to one thread.
  RecordCursor<StepRecord> steps() const;
  RecordCursor<SampleRecord> samples() const;
  RecordCursor<EventRecord> events() const;
  RecordCursor<ArrayHashRecord> array_hashes() const;

  /// Writes the source files below `folder` so that load_model(folder, task) finds what the session ran on.
  /// Throws InputError for a path that would leave the folder.
  void write_sources(const std::string& folder) const;

 private:
  std::shared_ptr<detail::RecordingFile> file_;
};

/// Every *.yaml file below root/models and root/curricula, by path: what a recording keeps so that it can be
/// replayed after the files have changed.
std::vector<SourceFile> read_sources(const std::string& root);

}  // namespace filum
