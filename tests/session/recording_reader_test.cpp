#include "session/recording_reader.h"

#include <gtest/gtest.h>
#include <soci/sqlite3/soci-sqlite3.h>

#include <fstream>
#include <thread>

#include "base/error.h"
#include "base/rng.h"
#include "session/database.h"
#include "session/recorder.h"
#include "tests/session/synthetic.h"

namespace filum {
namespace recording_reader_test {

using synthetic::Folder;

std::string bytes_of(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

void write_bytes(const std::string& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary | std::ios::trunc) << bytes;
}

/// Everything in a recording as one hash; throws InputError when any of it is damaged.
std::uint64_t read_whole(const std::string& file) {
  const RecordingReader recording(file);
  if (const auto damage = recording.find_damage(); !damage.empty()) throw InputError(file, "recording", damage.front(), "none");
  std::uint64_t hash = recording.finished() ? 1 : 0;
  StepRecord step;
  SampleRecord sample;
  EventRecord event;
  ArrayHashRecord array_hash;
  std::vector<char> bytes;
  for (auto cursor = recording.steps(); cursor.next(step);) {
    pack(std::span<const StepRecord>(&step, 1), recording.meta().n_tools, bytes);
    hash = hash_bytes(bytes.data(), bytes.size(), hash);
  }
  for (auto cursor = recording.samples(); cursor.next(sample);) {
    pack(std::span<const SampleRecord>(&sample, 1), bytes);
    hash = hash_bytes(bytes.data(), bytes.size(), hash);
  }
  for (auto cursor = recording.events(); cursor.next(event);) {
    pack(std::span<const EventRecord>(&event, 1), bytes);
    hash = hash_bytes(bytes.data(), bytes.size(), hash);
  }
  for (auto cursor = recording.array_hashes(); cursor.next(array_hash);) {
    pack(std::span<const ArrayHashRecord>(&array_hash, 1), bytes);
    hash = hash_bytes(bytes.data(), bytes.size(), hash);
  }
  for (const SourceFile& source : recording.sources()) hash = hash_text(source.path + source.text, hash);
  if (const auto& score = recording.score()) hash = hash_text(score->json, hash);
  return hash_text(recording.meta().task + recording.meta().participant + recording.meta().started_utc, hash);
}

TEST(RecordingReader, CursorsAreIndependent) {
  const Folder folder;
  synthetic::write_recording(folder.file("a"), 600);
  const RecordingReader recording(folder.file("a"));
  auto first = recording.steps();
  auto second = recording.steps();
  StepRecord a;
  StepRecord b;
  for (int i = 0; i < 300; ++i) ASSERT_TRUE(first.next(a));
  ASSERT_TRUE(second.next(b));
  EXPECT_EQ(a.step, 300u);
  EXPECT_EQ(b.step, 1u);
}

TEST(RecordingReader, RefusesWhatIsNoRecording) {
  const Folder folder;
  EXPECT_THROW(RecordingReader(folder.file("none")), InputError);
  EXPECT_THROW(RecordingReader(folder.path().string()), InputError);
  write_bytes(folder.file("text"), "not a recording at all\n");
  EXPECT_THROW(RecordingReader(folder.file("text")), InputError);
  write_bytes(folder.file("empty"), "");
  EXPECT_THROW(RecordingReader(folder.file("empty")), InputError);
  {
    soci::session sql(soci::sqlite3, database::connection_string(folder.file("foreign"), false));
    sql << "CREATE TABLE texts (a INTEGER)";
  }
  EXPECT_THROW(RecordingReader(folder.file("foreign")), InputError);
}

TEST(RecordingReader, SaysWhenAFileIsFromANewerProgram) {
  const Folder folder;
  synthetic::write_recording(folder.file("a"), 10);
  {
    soci::session sql(soci::sqlite3, database::connection_string(folder.file("a"), false));
    sql << "PRAGMA user_version = 3";
  }
  try {
    RecordingReader recording(folder.file("a"));
    FAIL() << "a newer format was taken";
  } catch (const InputError& error) {
    EXPECT_NE(
        std::string(error.what()).find("format: found 3, made by a newer Filum, expected a format up to 2"),
        std::string::npos)
        << error.what();
  }
}

TEST(RecordingReader, EveryTruncationIsAnInputError) {
  const Folder folder;
  synthetic::write_recording(folder.file("a"), 300);
  const std::string whole = bytes_of(folder.file("a"));
  for (std::size_t size = 0; size < whole.size(); size += 509) {
    write_bytes(folder.file("cut"), whole.substr(0, size));
    EXPECT_THROW(read_whole(folder.file("cut")), InputError) << size << " of " << whole.size();
  }
}

TEST(RecordingReader, AFlippedBitIsFoundOrDoesNotMatter) {
  const Folder folder;
  synthetic::write_recording(folder.file("a"), 300);
  const std::uint64_t right = read_whole(folder.file("a"));
  const std::string whole = bytes_of(folder.file("a"));
  Rng rng(5);
  int found = 0;
  for (int i = 0; i < 400; ++i) {
    std::string changed = whole;
    const std::size_t at = rng.below(whole.size());
    changed[at] = static_cast<char>(changed[at] ^ (1 << rng.below(8)));
    write_bytes(folder.file("flipped"), changed);
    try {
      EXPECT_EQ(read_whole(folder.file("flipped")), right)
          << "byte " << at << " changed the content unnoticed";
    } catch (const InputError&) {
      ++found;
    }
  }
  EXPECT_GT(found, 200);  // most of the file is records
}

/// Turns one bit of what a table holds in a row.
void flip(const std::string& file, const std::string& change) {
  soci::session sql(soci::sqlite3, database::connection_string(file, false));
  sql << change;
}

template <class Record>
int count_readable(RecordCursor<Record> cursor) {
  Record record;
  int n = 0;
  while (cursor.next_readable(record)) ++n;
  return n;
}

using Damage = std::vector<std::string>;

TEST(RecordingReader, DamageIsNamedByItsPlaceAndWhatIsBesideItIsRead) {
  const Folder folder;
  synthetic::write_recording(folder.file("a"), 1000);
  EXPECT_EQ(RecordingReader(folder.file("a")).find_damage(), Damage{});
  for (const char* table : {"steps", "samples", "events", "array_hashes"}) {
    const std::string file = folder.file(std::string("a ") + table);
    std::filesystem::copy_file(folder.file("a"), file);
    flip(file, std::string("UPDATE ") + table + " SET data = CAST(x'00' || substr(data, 2) AS BLOB) WHERE id = 1");
    const RecordingReader recording(file);
    EXPECT_EQ(recording.find_damage(), Damage{std::string(table) + " block 1 with a wrong checksum"});
    EXPECT_EQ(recording.last_step(), 1000u);
  }
  const RecordingReader whole(folder.file("a")), samples(folder.file("a samples")), events(folder.file("a events"));
  EXPECT_EQ(count_readable(whole.samples()), 2000);
  EXPECT_EQ(count_readable(samples.steps()), 1000);
  EXPECT_EQ(count_readable(samples.samples()), 2000 - 256) << "blocks behind the damaged one are read";
  EXPECT_LT(count_readable(events.events()), count_readable(whole.events()));
  SampleRecord record;
  auto cursor = samples.samples();
  EXPECT_THROW(cursor.next(record), InputError);
  ASSERT_TRUE(cursor.next(record)) << "and goes on";
  EXPECT_TRUE(synthetic::same(record, synthetic::sample(2 + 256)));
}

TEST(RecordingReader, SeveralPlacesAreAllNamedAndABlockThatIsGoneToo) {
  const Folder folder;
  synthetic::write_recording(folder.file("a"), 1000);
  flip(folder.file("a"), "UPDATE samples SET hash = hash + 1 WHERE id = 3");
  flip(folder.file("a"), "DELETE FROM samples WHERE id = 5");
  flip(folder.file("a"), "UPDATE texts SET value = value || ' ' WHERE name = 'models/suture/test.yaml'");
  const RecordingReader recording(folder.file("a"));
  EXPECT_EQ(recording.find_damage(), (Damage{"source models/suture/test.yaml with a wrong checksum", "samples block 3 with a wrong checksum", "samples block 5 missing"}));
  EXPECT_EQ(count_readable(recording.samples()), 2000 - 2 * 256);
  EXPECT_EQ(recording.sources().size(), 1u) << "the source beside it";
  EXPECT_TRUE(recording.score().has_value());
}

TEST(RecordingReader, ANameThatWasChangedInTheFileIsNoticed) {
  const Folder folder;
  synthetic::write_recording(folder.file("a"), 20);
  std::string bytes = bytes_of(folder.file("a"));
  const std::size_t at = bytes.find("models/suture/test.yaml");
  ASSERT_NE(at, std::string::npos);
  bytes[at] = 'M';
  write_bytes(folder.file("a"), bytes);
  const Damage damage = RecordingReader(folder.file("a")).find_damage();
  ASSERT_EQ(damage.size(), 1u);
  EXPECT_EQ(damage[0].find("structure of the file: "), 0u) << damage[0];
}

TEST(RecordingReader, WithoutItsDescriptionNothingIsRead) {
  const Folder folder;
  synthetic::write_recording(folder.file("a"), 20);
  flip(folder.file("a"), "UPDATE texts SET hash = hash + 1 WHERE kind = 'meta' AND name = 'meta'");
  try {
    RecordingReader recording(folder.file("a"));
    FAIL() << "read";
  } catch (const InputError& error) {
    EXPECT_EQ(error.value, "no description of itself (meta meta with a wrong checksum)");
  }
}

TEST(RecordingReader, TheLastStepIsThatOfTheLastBlockThatCanBeRead) {
  const Folder folder;
  synthetic::write_recording(folder.file("a"), 1000);
  EXPECT_EQ(RecordingReader(folder.file("a")).last_step(), 1000u);
  flip(folder.file("a"), "UPDATE steps SET hash = hash + 1 WHERE id = (SELECT max(id) FROM steps)");
  const std::uint64_t before = RecordingReader(folder.file("a")).last_step();
  EXPECT_LT(before, 1000u);
  EXPECT_GE(before, 1000u - 256u);
  synthetic::write_recording(folder.file("none"), 0);
  EXPECT_EQ(RecordingReader(folder.file("none")).last_step(), 0u);
}

TEST(RecordingReader, EventsOfFormat1AreReadWithoutText) {
  const Folder folder;
  EventRecord with = synthetic::event(1), without = with;
  with.text = "square";
  {
    Recorder recorder(synthetic::options(folder.file("a")));
    recorder.record_event(with);
    ASSERT_TRUE(recorder.close());
  }
  std::vector<char> bytes;
  pack(std::span<const EventRecord>(&without, 1), bytes);
  bytes.pop_back();  // the length of its empty text
  {
    soci::session sql(soci::sqlite3, database::connection_string(folder.file("a"), false));
    std::string hex;
    for (const char c : bytes) {
      char two[3];
      std::snprintf(two, sizeof two, "%02x", static_cast<unsigned>(static_cast<unsigned char>(c)));
      hex += two;
    }
    const auto hash = static_cast<long long>(hash_bytes(bytes.data(), bytes.size(), 1));
    EventRecord read;
    ASSERT_TRUE(RecordingReader(folder.file("a")).events().next(read));
    EXPECT_EQ(read.text.view(), "square");
    sql << "UPDATE events SET data = x'" + hex + "', hash = :h", soci::use(hash);
    sql << "PRAGMA user_version = 1";
  }
  const RecordingReader old(folder.file("a"));
  EXPECT_EQ(old.meta().format, 1);
  EXPECT_EQ(old.find_damage(), Damage{});
  EventRecord read;
  ASSERT_TRUE(old.events().next(read));
  EXPECT_TRUE(synthetic::same(read, without));
}

TEST(RecordingReader, AMissingBlockIsFound) {
  const Folder folder;
  synthetic::write_recording(folder.file("a"), 1000);
  {
    soci::session sql(soci::sqlite3, database::connection_string(folder.file("a"), false));
    sql << "DELETE FROM steps WHERE id = 2";
  }
  EXPECT_THROW(read_whole(folder.file("a")), InputError);
}

TEST(RecordingReader, AFinishedRecordingMissesItsLastBlocks) {
  const Folder folder;
  synthetic::write_recording(folder.file("a"), 1000);
  for (const auto& [table, last] : {std::pair{"steps", "4"}, {"samples", "8"}, {"events", "1"}, {"array_hashes", "1"}}) {
    const std::string file = folder.file(table);
    std::filesystem::copy_file(folder.file("a"), file);
    flip(file, std::string("DELETE FROM ") + table + " WHERE id = " + last);
    EXPECT_EQ(RecordingReader(file).find_damage(), Damage{std::string(table) + " block " + last + " missing"});
  }
  flip(folder.file("a"), "DELETE FROM samples WHERE id > 5");
  const RecordingReader cut(folder.file("a"));
  EXPECT_EQ(cut.find_damage(), Damage{"samples block 6 and those behind it missing"});
  EXPECT_EQ(count_readable(cut.samples()), 5 * 256);
}

/// Before, "finished" was all that was said.
TEST(RecordingReader, AnEndThatDoesNotSayHowMuchThereWasIsNoDamage) {
  const Folder folder;
  synthetic::write_recording(folder.file("a"), 1000);
  flip(folder.file("a"), "UPDATE texts SET value = 'true', hash = " + std::to_string(static_cast<long long>(hash_text("true"))) + " WHERE name = 'finished'");
  EXPECT_TRUE(RecordingReader(folder.file("a")).finished());
  EXPECT_EQ(RecordingReader(folder.file("a")).find_damage(), Damage{});
}

/// A recording as a crash leaves it: the file and its journal, without the closing that folds them together.
void write_killed(const std::string& scratch, const std::string& to) {
  Recorder recorder(synthetic::options(scratch));
  for (std::uint64_t i = 1; i <= 600; ++i) {
    recorder.record_step(synthetic::step(i));
    if (i % 60 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(25));  // a commit or more each
  }
  for (int i = 0; i < 10000 && recorder.status().steps_stored < 600; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  ASSERT_EQ(recorder.status().steps_stored, 600u) << recorder.status().message;
  std::filesystem::copy_file(scratch, to);
  std::filesystem::copy_file(scratch + "-wal", to + "-wal");
}

TEST(RecordingReader, AKilledRecordingWithoutItsJournalIsNoEmptyOne) {
  const Folder folder;
  write_killed(folder.file("live"), folder.file("a"));
  EXPECT_EQ(RecordingReader(folder.file("a")).find_damage(), Damage{});
  EXPECT_EQ(RecordingReader(folder.file("a")).last_step(), 600u);
  std::filesystem::copy_file(folder.file("a"), folder.file("b"));
  const Damage damage = RecordingReader(folder.file("b")).find_damage();
  ASSERT_EQ(damage.size(), 1u);
  EXPECT_NE(damage[0].find("journal (" + folder.file("b") + "-wal)"), std::string::npos) << damage[0];
}

TEST(RecordingReader, AJournalWithAFlippedBitIsNoShorterSession) {
  const Folder folder;
  write_killed(folder.file("live"), folder.file("a"));
  const std::string log = bytes_of(folder.file("a-wal"));
  std::string flipped = log;
  flipped[log.size() / 2] = static_cast<char>(flipped[log.size() / 2] ^ 4);
  write_bytes(folder.file("a-wal"), flipped);
  const RecordingReader recording(folder.file("a"));
  EXPECT_LT(recording.last_step(), 600u);
  const Damage damage = recording.find_damage();
  ASSERT_EQ(damage.size(), 1u);
  EXPECT_NE(damage[0].find("with a wrong checksum, and what was recorded after it"), std::string::npos) << damage[0];
}

TEST(RecordingReader, ACrashedRecordingInAReadOnlyFolderIsRead) {
  const Folder folder;
  const std::string locked = folder.file("locked");
  std::filesystem::create_directory(locked);
  std::filesystem::permissions(folder.path(), std::filesystem::perms(0755));
  {
    RecorderOptions options = synthetic::options(folder.file("live"));
    Recorder recorder(options);
    for (std::uint64_t i = 1; i <= 100; ++i) recorder.record_step(synthetic::step(i));
    for (int i = 0; i < 10000 && recorder.status().steps_stored < 100; ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    ASSERT_EQ(recorder.status().steps_stored, 100u) << recorder.status().message;
    // As after a crash: the file and its journal, without the closing that folds them together.
    std::filesystem::copy_file(folder.file("live"), locked + "/a");
    std::filesystem::copy_file(folder.file("live-wal"), locked + "/a-wal");
  }
  std::filesystem::permissions(locked + "/a", std::filesystem::perms(0444));
  std::filesystem::permissions(locked + "/a-wal", std::filesystem::perms(0444));
  std::filesystem::permissions(locked, std::filesystem::perms(0555));
  const synthetic::OrdinaryUser user;
  ASSERT_TRUE(user.is());
  const RecordingReader recording(locked + "/a");
  auto cursor = recording.steps();
  StepRecord record;
  int n = 0;
  while (cursor.next(record)) ++n;
  EXPECT_EQ(n, 100);
}

TEST(RecordingReader, SourcesAreWrittenBelowTheFolderOnly) {
  const Folder folder;
  synthetic::write_recording(folder.file("a"), 3);
  RecordingReader(folder.file("a")).write_sources(folder.file("out"));
  EXPECT_EQ(bytes_of(folder.file("out/models/suture/test.yaml")), "diameter: 25 um\n");
  RecorderOptions options = synthetic::options(folder.file("b"));
  options.sources = {{"../escaped.yaml", "x: 1\n"}};
  Recorder(options).close();
  EXPECT_THROW(RecordingReader(folder.file("b")).write_sources(folder.file("out")), InputError);
  EXPECT_FALSE(std::filesystem::exists(folder.file("escaped.yaml")));
}

TEST(RecordingReader, SourcesOfAProjectAreFoundByPath) {
  const Folder folder;
  std::filesystem::create_directories(folder.path() / "models/suture");
  std::filesystem::create_directories(folder.path() / "curricula");
  write_bytes(folder.file("models/suture/b.yaml"), "b: 1\n");
  write_bytes(folder.file("models/a.yaml"), "a: 1\n");
  write_bytes(folder.file("models/mesh.bin"), "x");
  write_bytes(folder.file("curricula/c.yaml"), "c: 1\n");
  const std::vector<SourceFile> sources = read_sources(folder.path().string());
  ASSERT_EQ(sources.size(), 3u);
  EXPECT_EQ(sources[0].path, "curricula/c.yaml");
  EXPECT_EQ(sources[1].path, "models/a.yaml");
  EXPECT_EQ(sources[2].path, "models/suture/b.yaml");
  EXPECT_EQ(sources[2].text, "b: 1\n");
}

}  // namespace recording_reader_test
}  // namespace filum
