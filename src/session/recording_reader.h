#pragma once
// Reads a recording, finished or cut off by a crash. Every checksum is compared; whatever is wrong with the
// file becomes an InputError that names it: not a recording, made by a newer program, cut short, damaged. What
// stands beside the damage is still read.

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

/// One kind of record in the order it was stored.
template <class Record>
class RecordCursor {
 public:
  /// False at the end. Throws InputError, whose value names the block, at a damaged block; called again it goes
  /// on behind that.
  bool next(Record& record);
  /// As next(), past damaged blocks: find_damage() tells of them.
  bool next_readable(Record& record);

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
  /// Throws InputError when the file is no recording this program can read or does not tell what it is of. Sources
  /// and score that are damaged are left out; find_damage() tells of them. Never writes beside a file in a
  /// folder that is read-only: a crashed recording there is copied to a temporary folder first.
  explicit RecordingReader(const std::string& file);

  const std::string& file() const;
  const RecordingMeta& meta() const;
  /// False: the program ended before close(); the records are good up to the last commit.
  bool finished() const;
  const std::vector<SourceFile>& sources() const;
  /// Sources and score that are left out, as find_damage() names them.
  const std::vector<std::string>& damaged_texts() const;
  const std::optional<ScoreRecord>& score() const;

  /// Number of the last step, from the last block that can be read; 0: none.
  std::uint64_t last_step() const;
  /// All that is wrong with the file by its place, "events block 3 with a wrong checksum". Reads all of it.
  std::vector<std::string> find_damage() const;

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
