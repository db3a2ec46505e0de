#include "session/block_writer.h"

#include <soci/sqlite3/soci-sqlite3.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/hash.h"
#include "session/database.h"
#include "session/recorder.h"

namespace filum {
namespace {

constexpr std::size_t kBlock = 256;  // records at most in one row

void create_tables(soci::session& sql) {
  sql << "CREATE TABLE texts (kind TEXT NOT NULL, name TEXT NOT NULL, value TEXT NOT NULL, hash INTEGER NOT "
         "NULL, "
         "PRIMARY KEY (kind, name))";
  for (const char* table : {"steps", "samples", "events", "array_hashes"})
    sql << "CREATE TABLE " << table
        << " (id INTEGER PRIMARY KEY, count INTEGER NOT NULL, data BLOB NOT NULL, hash INTEGER NOT NULL)";
}

std::string json_of(const RecordingMeta& meta) {
  const nlohmann::json json = {
      {"program", meta.program},         {"task", meta.task},   {"participant", meta.participant},
      {"started_utc", meta.started_utc}, {"input", meta.input}, {"dt", meta.dt},
      {"n_tools", meta.n_tools}};
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string json_of(const ScoreRecord& score) {
  const nlohmann::json json = {
      {"passed", score.passed}, {"total", score.total}, {"seconds", score.seconds}, {"json", score.json}};
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace

struct BlockWriter::Impl {
  explicit Impl(const std::string& file)
      : file(file), sql(soci::sqlite3, database::connection_string(file, false)) {}

  void put_text(const std::string& kind, const std::string& name, const std::string& value) {
    const long long hash = static_cast<long long>(hash_text(value));
    sql << "INSERT OR REPLACE INTO texts (kind, name, value, hash) VALUES (:kind, :name, :value, :hash)",
        soci::use(kind), soci::use(name), soci::use(value), soci::use(hash);
  }

  /// One kind of records, block by block; `ids` counts the rows of its table.
  template <class Record, class Pack>
  void put_blocks(const char* table, const std::vector<Record>& records, long long& id, Pack&& pack_records) {
    if (records.empty()) return;
    soci::blob blob(sql);
    long long count = 0;
    long long hash = 0;
    soci::statement insert = (sql.prepare << "INSERT INTO " << table
                                          << " (id, count, data, hash) VALUES (:id, :count, :data, :hash)",
                              soci::use(id), soci::use(count), soci::use(blob), soci::use(hash));
    for (std::size_t first = 0; first < records.size(); first += kBlock) {
      const std::size_t n = std::min(kBlock, records.size() - first);
      pack_records(std::span<const Record>(records).subspan(first, n));
      database::set_bytes(blob, bytes);
      ++id;
      count = static_cast<long long>(n);
      hash = static_cast<long long>(hash_bytes(bytes.data(), bytes.size(), static_cast<std::uint64_t>(id)));
      insert.execute(true);
    }
  }

  std::string file;
  soci::session sql;
  int n_tools = 0;
  std::vector<char> bytes;
  /// The last block of each table.
  struct Ids {
    long long steps = 0, samples = 0, events = 0, array_hashes = 0;
    /// A finished recording says how many there are: a last one that is lost later leaves no gap to be missed by.
    std::string json() const { return nlohmann::json({{"steps", steps}, {"samples", samples}, {"events", events}, {"array_hashes", array_hashes}}).dump(); }
  } ids;
};

/// Leaves no file behind. Called from a handler.
void BlockWriter::give_up(const std::string& file, const std::exception& error) {
  impl_.reset();
  std::error_code ignored;
  std::filesystem::remove(file, ignored);
  throw InputError(file, "recording", database::reason(error), "a folder that can be written, with space left");
}

BlockWriter::BlockWriter(const std::string& file, const RecordingMeta& meta,
                         const std::vector<SourceFile>& sources) {
  try {
    impl_ = std::make_unique<Impl>(file);
    impl_->n_tools = meta.n_tools;
    soci::session& sql = impl_->sql;
    soci::transaction transaction(sql);
    database::mark(sql, database::kRecordingId, kRecordingFormat);
    create_tables(sql);
    impl_->put_text("meta", "meta", json_of(meta));
    for (const SourceFile& source : sources) impl_->put_text("source", source.path, source.text);
    transaction.commit();
    // WAL only now: the identity of the file must stand in the file itself.
    if (database::pragma(sql, "journal_mode = WAL") != "wal")
      throw std::runtime_error("no write-ahead log here");
    sql << "PRAGMA synchronous = NORMAL";
    // A checkpoint syncs the disk, which may take longer than the 100 ms that may be lost; finish() does it.
    database::pragma(sql, "wal_autocheckpoint = 0");
  } catch (const std::exception& error) {
    give_up(file, error);
  }
}

void BlockWriter::begin() {
  try {
    impl_->put_text("meta", "log", "begun");
  } catch (const std::exception& error) {
    give_up(std::string(impl_->file), error);
  }
}

BlockWriter::~BlockWriter() = default;

void BlockWriter::commit(const Batch& batch) {
  Impl& impl = *impl_;
  const Impl::Ids before = impl.ids;
  try {
    soci::transaction transaction(impl.sql);
    impl.put_blocks("steps", batch.steps, impl.ids.steps,
                    [&](std::span<const StepRecord> some) { pack(some, impl.n_tools, impl.bytes); });
    impl.put_blocks("samples", batch.samples, impl.ids.samples,
                    [&](std::span<const SampleRecord> some) { pack(some, impl.bytes); });
    impl.put_blocks("events", batch.events, impl.ids.events,
                    [&](std::span<const EventRecord> some) { pack(some, impl.bytes); });
    impl.put_blocks("array_hashes", batch.array_hashes, impl.ids.array_hashes,
                    [&](std::span<const ArrayHashRecord> some) { pack(some, impl.bytes); });
    if (batch.score) impl.put_text("score", "score", json_of(*batch.score));
    transaction.commit();
  } catch (...) {
    impl.ids = before;
    throw;
  }
}

void BlockWriter::finish() {
  soci::session& sql = impl_->sql;
  impl_->put_text("meta", "finished", impl_->ids.json());
  database::pragma(sql, "wal_checkpoint(TRUNCATE)");
  database::pragma(sql, "journal_mode = DELETE");
}

}  // namespace filum
