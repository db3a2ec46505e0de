#include "session/recording_reader.h"

#include <soci/sqlite3/soci-sqlite3.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/hash.h"
#include "session/database.h"
#include "session/journal.h"
#include "session/recorder.h"

namespace filum {
namespace fs = std::filesystem;
namespace {

constexpr const char* kWanted = "a recording made by Filum";
constexpr const char* kSound = "an undamaged recording";

/// A folder of its own that goes away with the object.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (fs::temp_directory_path() / "filum-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw InputError(name, "folder", "an error", "a temporary folder");
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

}  // namespace

namespace detail {

class RecordingFile {
 public:
  explicit RecordingFile(const std::string& name) : file(name) {
    database::require_format(file, kWanted, database::kRecordingId, kRecordingFormat);
    meta.format = database::read_header(file).format;
    try {
      open();
      read_texts();
    } catch (const InputError&) {
      throw;
    } catch (const std::exception& error) {
      damaged(database::reason(error));
    }
  }

  [[noreturn]] void damaged(const std::string& what) const {
    throw InputError(file, "recording", what, kSound);
  }

  /// The block after `id` of a table: false at the end. Blocks are numbered from 1 without a gap. After an
  /// InputError `id` is such that the next call goes on behind the damage.
  bool next_block(const char* table, long long& id, std::size_t& count, std::vector<char>& bytes) {
    long long found = 0;
    long long stored_count = 0;
    long long hash = 0;
    if (id == kNoMore) return false;
    const long long wanted = id + 1;
    bool got = false;
    try {
      soci::blob blob(*sql);
      *sql << "SELECT id, count, data, hash FROM " << table << " WHERE id >= " << wanted << " ORDER BY id LIMIT 1",
          soci::into(found), soci::into(stored_count), soci::into(blob), soci::into(hash);
      got = sql->got_data();
      if (got) bytes = database::bytes_of(blob);
    } catch (const std::exception& error) {
      id = kNoMore;
      damaged(where(table, wanted) + " and those behind it: " + database::reason(error));
    }
    if (!got) {
      const auto end = ends.find(table);
      if (end == ends.end() || wanted > end->second) return false;
      id = kNoMore;
      damaged(where(table, wanted) + (wanted < end->second ? " and those behind it" : "") + " missing");
    }
    if (found != wanted) {
      id = found - 1;
      damaged(where(table, wanted) + " missing");
    }
    id = found;
    const std::uint64_t expected = hash_bytes(bytes.data(), bytes.size(), static_cast<std::uint64_t>(found));
    if (static_cast<std::uint64_t>(hash) != expected) damaged(where(table, found) + " with a wrong checksum");
    if (stored_count < 1 || stored_count > 1000000) damaged(where(table, found) + " with a wrong count");
    count = static_cast<std::size_t>(stored_count);
    return true;
  }

  static std::string where(const char* table, long long id) { return std::string(table) + " block " + std::to_string(id); }

  long long last_block(const char* table) {
    long long id = 0;
    try {
      *sql << "SELECT coalesce(max(id), 0) FROM " << table, soci::into(id);
    } catch (const std::exception& error) {
      damaged(std::string(table) + ": " + database::reason(error));
    }
    return id;
  }

  /// A recording that was not closed has all but its head in its journal.
  bool journal_lost() const { return !finished && !begun; }

  /// What the database itself finds: pages, and texts whose name stands otherwise in the index.
  std::string structure_damage() {
    std::string said;
    try {
      said = database::pragma(*sql, "integrity_check(1)");
    } catch (const std::exception& error) {
      said = database::reason(error);
    }
    std::replace(said.begin(), said.end(), '\n', ' ');
    return said == "ok" ? std::string() : "structure of the file: " + said;
  }

  std::string file;
  RecordingMeta meta;
  bool finished = false;
  bool begun = false;                      // the first commit into the journal is there
  std::map<std::string, long long> ends;   // last block of each table, where a finished recording says so
  std::vector<SourceFile> sources;
  std::optional<ScoreRecord> score;
  std::vector<std::string> damaged_texts;

 private:
  static constexpr long long kNoMore = std::numeric_limits<long long>::max();  // a block's number: nothing more can be read

  void open() {
    try {
      connect(file);
    } catch (const std::exception&) {
      // A crashed recording needs its journal played back; where the folder cannot be written that happens in
      // a copy.
      if (!fs::exists(file + "-wal")) throw;
      copy_ = std::make_unique<TemporaryFolder>();
      const fs::path copied = copy_->path() / "recording";
      fs::copy_file(file, copied);
      fs::copy_file(file + "-wal", copied.string() + "-wal");
      connect(copied.string());
    }
  }

  void connect(const std::string& name) {
    sql = std::make_unique<soci::session>(soci::sqlite3, database::connection_string(name, true));
    database::pragma(*sql, "trusted_schema = OFF");
    database::pragma(*sql, "cell_size_check = ON");
    int tables = 0;
    *sql << "SELECT count(*) FROM sqlite_master WHERE type = 'table' AND name IN "
            "('texts', 'steps', 'samples', 'events', 'array_hashes')",
        soci::into(tables);
    if (tables != 5) damaged("not all of its tables");
  }

  void read_texts() {
    bool has_meta = false;
    try {
      std::string kind, name, value;
      long long hash = 0;
      // by row, not by the index of names, which may be damaged; the description of the session is the first
      soci::statement select = (sql->prepare << "SELECT kind, name, value, hash FROM texts ORDER BY rowid",
                                soci::into(kind), soci::into(name), soci::into(value), soci::into(hash));
      select.execute();
      while (select.fetch()) {
        const bool sound = static_cast<std::uint64_t>(hash) == hash_text(value) && read_text(kind, name, value);
        if (!sound) damaged_texts.push_back(kind + " " + name + " with a wrong checksum");
        has_meta = has_meta || (sound && kind == "meta" && name == "meta");
      }
    } catch (const std::exception& error) {
      damaged_texts.push_back("texts: " + database::reason(error));
    }
    std::sort(sources.begin(), sources.end(), [](const SourceFile& a, const SourceFile& b) { return a.path < b.path; });
    if (!has_meta) damaged("no description of itself" + (damaged_texts.empty() ? "" : " (" + damaged_texts.front() + ")"));
  }

  /// False for a kind that there is not.
  bool read_text(const std::string& kind, const std::string& name, const std::string& value) {
    if (kind == "source") {
      sources.push_back({name, value});
    } else if (kind == "score") {
      read_score(value);
    } else if (kind == "meta" && name == "meta") {
      read_meta(value);
    } else if (kind == "meta" && name == "finished") {
      finished = true;
      read_ends(value);
    } else if (kind == "meta" && name == "log") {
      begun = true;
    } else {
      return false;
    }
    return true;
  }

  /// "true" from earlier programs, which did not say how much there was.
  void read_ends(const std::string& text) {
    const nlohmann::json json = nlohmann::json::parse(text);
    if (json.is_object()) json.get_to(ends);
  }

  void read_meta(const std::string& text) {
    const nlohmann::json json = nlohmann::json::parse(text);
    json.at("program").get_to(meta.program);
    json.at("task").get_to(meta.task);
    json.at("participant").get_to(meta.participant);
    json.at("started_utc").get_to(meta.started_utc);
    json.at("input").get_to(meta.input);
    json.at("dt").get_to(meta.dt);
    json.at("n_tools").get_to(meta.n_tools);
    if (!(meta.dt > 0.0 && meta.dt <= 0.1)) damaged("dt " + std::to_string(meta.dt) + " s");
    if (meta.n_tools < 0 || meta.n_tools > 3) damaged("n_tools " + std::to_string(meta.n_tools));
  }

  void read_score(const std::string& text) {
    const nlohmann::json json = nlohmann::json::parse(text);
    score.emplace();
    json.at("passed").get_to(score->passed);
    json.at("total").get_to(score->total);
    json.at("seconds").get_to(score->seconds);
    json.at("json").get_to(score->json);
  }

  std::unique_ptr<TemporaryFolder> copy_;  // outlives the connection
  std::unique_ptr<soci::session> sql;
};

namespace {

const char* table_of(const StepRecord*) {
  return "steps";
}
const char* table_of(const SampleRecord*) {
  return "samples";
}
const char* table_of(const EventRecord*) {
  return "events";
}
const char* table_of(const ArrayHashRecord*) {
  return "array_hashes";
}

bool unpack_block(std::span<const char> bytes, std::size_t count, const RecordingMeta& meta,
                  std::vector<StepRecord>& records) {
  return unpack(bytes, count, meta.n_tools, records);
}
bool unpack_block(std::span<const char> bytes, std::size_t count, const RecordingMeta& meta,
                  std::vector<EventRecord>& records) {
  return meta.format == 1 ? unpack_without_text(bytes, count, records) : unpack(bytes, count, records);
}
template <class Record>
bool unpack_block(std::span<const char> bytes, std::size_t count, const RecordingMeta&, std::vector<Record>& records) {
  return unpack(bytes, count, records);
}

template <class Record>
void add_damage(RecordCursor<Record> cursor, std::vector<std::string>& damage) {
  Record record;
  for (;;) {
    try {
      while (cursor.next(record)) {}
      return;
    } catch (const InputError& error) {
      damage.push_back(error.value);
    }
  }
}

}  // namespace
}  // namespace detail

template <class Record>
bool RecordCursor<Record>::next(Record& record) {
  if (at_ == block_.size()) {
    block_.clear();
    at_ = 0;
    const char* table = detail::table_of(static_cast<const Record*>(nullptr));
    std::size_t count = 0;
    std::vector<char> bytes;
    if (!file_->next_block(table, block_id_, count, bytes)) return false;
    if (!detail::unpack_block(bytes, count, file_->meta, block_)) {
      block_.clear();
      file_->damaged(file_->where(table, block_id_) + " of another length");
    }
  }
  record = block_[at_++];
  return true;
}

template <class Record>
bool RecordCursor<Record>::next_readable(Record& record) {
  for (;;) {
    try {
      return next(record);
    } catch (const InputError&) {
      // the next call goes on behind it
    }
  }
}

template class RecordCursor<StepRecord>;
template class RecordCursor<SampleRecord>;
template class RecordCursor<EventRecord>;
template class RecordCursor<ArrayHashRecord>;

RecordingReader::RecordingReader(const std::string& file)
    : file_(std::make_shared<detail::RecordingFile>(file)) {}

const std::string& RecordingReader::file() const {
  return file_->file;
}
const RecordingMeta& RecordingReader::meta() const {
  return file_->meta;
}
bool RecordingReader::finished() const {
  return file_->finished;
}
const std::vector<SourceFile>& RecordingReader::sources() const {
  return file_->sources;
}
const std::vector<std::string>& RecordingReader::damaged_texts() const {
  return file_->damaged_texts;
}
const std::optional<ScoreRecord>& RecordingReader::score() const {
  return file_->score;
}

std::uint64_t RecordingReader::last_step() const {
  std::vector<StepRecord> block;
  std::vector<char> bytes;
  std::size_t count = 0;
  try {
    constexpr int kMostTries = 10'000;  // numbers of blocks are what the file says
    int tries = 0;
    for (long long last = file_->last_block("steps"); last > 0 && tries < kMostTries; --last, ++tries) {
      try {
        long long id = last - 1;
        if (file_->next_block("steps", id, count, bytes) && unpack(bytes, count, meta().n_tools, block)) return block.back().step;
      } catch (const InputError&) {
        // the block before it, then
      }
    }
  } catch (const InputError&) {
    // no step can be read
  }
  return 0;
}

std::vector<std::string> RecordingReader::find_damage() const {
  std::vector<std::string> damage = file_->damaged_texts;
  detail::add_damage(steps(), damage);
  detail::add_damage(samples(), damage);
  detail::add_damage(events(), damage);
  detail::add_damage(array_hashes(), damage);
  if (file_->journal_lost()) damage.push_back("neither an end nor a journal (" + file_->file + "-wal), which holds what came after the beginning");
  if (!file_->finished)
    if (const std::string lost = journal_damage(file_->file + "-wal"); !lost.empty()) damage.push_back(lost);
  const std::string structure = file_->structure_damage();
  if (!structure.empty()) damage.push_back(structure);
  return damage;
}

RecordCursor<StepRecord> RecordingReader::steps() const {
  return RecordCursor<StepRecord>(file_);
}
RecordCursor<SampleRecord> RecordingReader::samples() const {
  return RecordCursor<SampleRecord>(file_);
}
RecordCursor<EventRecord> RecordingReader::events() const {
  return RecordCursor<EventRecord>(file_);
}
RecordCursor<ArrayHashRecord> RecordingReader::array_hashes() const {
  return RecordCursor<ArrayHashRecord>(file_);
}

void RecordingReader::write_sources(const std::string& folder) const {
  for (const SourceFile& source : sources()) {
    const fs::path path(source.path);
    const bool leaves =
        path.is_absolute() || std::find(path.begin(), path.end(), "..") != path.end() || path.empty();
    if (leaves)
      throw InputError(file(), "source", "\"" + source.path + "\"", "a path below the project's root");
    const fs::path target = fs::path(folder) / path;
    std::error_code error;
    fs::create_directories(target.parent_path(), error);
    std::ofstream stream(target, std::ios::binary);
    stream.write(source.text.data(), static_cast<std::streamsize>(source.text.size()));
    if (!stream.flush())
      throw InputError(target.string(), "source", "a write error", "a folder that can be written");
  }
}

std::vector<SourceFile> read_sources(const std::string& root) {
  std::vector<SourceFile> sources;
  for (const char* top : {"models", "curricula"}) {
    const fs::path folder = fs::path(root) / top;
    std::error_code error;
    for (fs::recursive_directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
      if (!it->is_regular_file() || it->path().extension() != ".yaml") continue;
      std::ifstream stream(it->path(), std::ios::binary);
      sources.push_back({it->path().lexically_relative(root).generic_string(),
                         {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()}});
    }
  }
  std::sort(sources.begin(), sources.end(),
            [](const SourceFile& a, const SourceFile& b) { return a.path < b.path; });
  return sources;
}

}  // namespace filum
