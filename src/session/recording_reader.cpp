#include "session/recording_reader.h"

#include <soci/sqlite3/soci-sqlite3.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/hash.h"
#include "session/database.h"
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

  /// The block after `id` of a table: false at the end. Blocks are numbered from 1 without a gap.
  bool next_block(const char* table, long long& id, std::size_t& count, std::vector<char>& bytes) {
    long long found = 0;
    long long stored_count = 0;
    long long hash = 0;
    try {
      soci::blob blob(*sql);
      *sql << "SELECT id, count, data, hash FROM " << table << " WHERE id > " << id << " ORDER BY id LIMIT 1",
          soci::into(found), soci::into(stored_count), soci::into(blob), soci::into(hash);
      if (!sql->got_data()) return false;
      bytes = database::bytes_of(blob);
    } catch (const std::exception& error) {
      damaged(std::string(table) + ": " + database::reason(error));
    }
    const std::string where = std::string(table) + " block " + std::to_string(id + 1);
    if (found != id + 1) damaged(where + " missing");
    const std::uint64_t expected = hash_bytes(bytes.data(), bytes.size(), static_cast<std::uint64_t>(found));
    if (static_cast<std::uint64_t>(hash) != expected) damaged(where + " with a wrong checksum");
    if (stored_count < 1 || stored_count > 1000000) damaged(where + " with a wrong count");
    id = found;
    count = static_cast<std::size_t>(stored_count);
    return true;
  }

  std::string file;
  RecordingMeta meta;
  bool finished = false;
  std::vector<SourceFile> sources;
  std::optional<ScoreRecord> score;

 private:
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
    std::string kind;
    std::string name;
    std::string value;
    long long hash = 0;
    soci::statement select = (sql->prepare << "SELECT kind, name, value, hash FROM texts ORDER BY kind, name",
                              soci::into(kind), soci::into(name), soci::into(value), soci::into(hash));
    select.execute();
    bool has_meta = false;
    while (select.fetch()) {
      if (static_cast<std::uint64_t>(hash) != hash_text(value))
        damaged(kind + " " + name + " with a wrong checksum");
      if (kind == "source") sources.push_back({name, value});
      if (kind == "score") read_score(value);
      if (kind == "meta" && name == "finished") finished = true;
      if (kind == "meta" && name == "meta") {
        read_meta(value);
        has_meta = true;
      }
    }
    if (!has_meta) damaged("no description of itself");
  }

  void read_meta(const std::string& text) {
    const nlohmann::json json = nlohmann::json::parse(text);
    meta.format = kRecordingFormat;
    json.at("program").get_to(meta.program);
    json.at("task").get_to(meta.task);
    json.at("participant").get_to(meta.participant);
    json.at("started_utc").get_to(meta.started_utc);
    json.at("input").get_to(meta.input);
    json.at("dt").get_to(meta.dt);
    json.at("n_tools").get_to(meta.n_tools);
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

bool unpack_block(std::span<const char> bytes, std::size_t count, int n_tools,
                  std::vector<StepRecord>& records) {
  return unpack(bytes, count, n_tools, records);
}
template <class Record>
bool unpack_block(std::span<const char> bytes, std::size_t count, int, std::vector<Record>& records) {
  return unpack(bytes, count, records);
}

}  // namespace
}  // namespace detail

template <class Record>
bool RecordCursor<Record>::next(Record& record) {
  if (at_ == block_.size()) {
    const char* table = detail::table_of(static_cast<const Record*>(nullptr));
    std::size_t count = 0;
    std::vector<char> bytes;
    if (!file_->next_block(table, block_id_, count, bytes)) return false;
    if (!detail::unpack_block(bytes, count, file_->meta.n_tools, block_))
      file_->damaged(std::string(table) + " block " + std::to_string(block_id_) + " of another length");
    at_ = 0;
  }
  record = block_[at_++];
  return true;
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
const std::optional<ScoreRecord>& RecordingReader::score() const {
  return file_->score;
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
