#include "session/block_writer.h"

#include <gtest/gtest.h>
#include <soci/sqlite3/soci-sqlite3.h>

#include "base/error.h"
#include "session/database.h"
#include "session/recording_reader.h"
#include "tests/session/synthetic.h"

namespace filum {
namespace block_writer_test {

using synthetic::Folder;

const std::vector<SampleRecord> kNoSamples;
const std::vector<EventRecord> kNoEvents;
const std::vector<ArrayHashRecord> kNoHashes;
const std::optional<ScoreRecord> kNoScore;

std::vector<StepRecord> steps(std::uint64_t first, std::uint64_t last) {
  std::vector<StepRecord> records;
  for (std::uint64_t i = first; i <= last; ++i) records.push_back(synthetic::step(i));
  return records;
}

TEST(BlockWriter, CommittedBlocksAreReadableWhileTheWriterIsOpen) {
  const Folder folder;
  BlockWriter writer(folder.file("a"), synthetic::meta(), {});
  writer.commit({steps(1, 700), kNoSamples, kNoEvents, kNoHashes, kNoScore});
  writer.commit({steps(701, 703), kNoSamples, kNoEvents, kNoHashes, kNoScore});
  const RecordingReader recording(folder.file("a"));
  auto cursor = recording.steps();
  StepRecord record;
  std::uint64_t n = 0;
  while (cursor.next(record)) ASSERT_EQ(record.step, ++n);
  EXPECT_EQ(n, 703u);
  EXPECT_FALSE(recording.finished());
}

TEST(BlockWriter, ARefusedCommitLeavesNothingAndCanBeRepeated) {
  const Folder folder;
  BlockWriter writer(folder.file("a"), synthetic::meta(), {});
  {
    soci::session other(soci::sqlite3, database::connection_string(folder.file("a"), false));
    other << "CREATE TRIGGER refuse BEFORE INSERT ON events BEGIN SELECT RAISE(ABORT, 'refused'); END";
    const std::vector<EventRecord> events{synthetic::event(1)};
    EXPECT_THROW(writer.commit({steps(1, 5), kNoSamples, events, kNoHashes, kNoScore}), soci::soci_error);
    other << "DROP TRIGGER refuse";
  }
  writer.commit({steps(1, 5), kNoSamples, kNoEvents, kNoHashes, kNoScore});
  writer.finish();
  const RecordingReader recording(folder.file("a"));
  auto cursor = recording.steps();
  StepRecord record;
  std::uint64_t n = 0;
  while (cursor.next(record)) ASSERT_EQ(record.step, ++n);
  EXPECT_EQ(n, 5u);
}

}  // namespace block_writer_test
}  // namespace filum
