#include "session/store.h"

#include <soci/sqlite3/soci-sqlite3.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "base/error.h"
#include "base/file_kind.h"
#include "session/database.h"
#include "session/recorder.h"
#include "session/recording_reader.h"

namespace filum {
namespace fs = std::filesystem;
namespace {

constexpr const char* kColumns =
    "id, task, participant, started_utc, seconds, finished, scored, passed, total";

fs::path index_path(const std::string& folder) {
  return fs::path(folder) / "index.sqlite";
}

/// "2026-11-21T09:30:00Z" -> "20261121T093000Z"
std::string compact(const std::string& utc) {
  std::string text;
  for (const char c : utc)
    if (c != '-' && c != ':') text += c;
  return text;
}

/// Whatever stands in a task's name, its file name holds letters, digits and dashes only.
std::string word(const std::string& text) {
  std::string out;
  for (const char c : text) out += is_participant_code(std::string_view(&c, 1)) ? c : '-';
  return out;
}

/// Columns of one row, bound for SOCI.
struct Row {
  StoreEntry entry;
  int finished = 0, scored = 0, passed = 0;

  StoreEntry filled() const {
    StoreEntry out = entry;
    out.finished = finished != 0;
    out.scored = scored != 0;
    out.passed = passed != 0;
    return out;
  }
};

StoreEntry entry_of(const RecordingReader& recording, const std::string& id) {
  StoreEntry entry;
  entry.id = id;
  entry.task = recording.meta().task;
  entry.participant = recording.meta().participant;
  entry.started_utc = recording.meta().started_utc;
  entry.finished = recording.finished();
  if (const auto& score = recording.score()) {
    entry.scored = true;
    entry.passed = score->passed;
    entry.total = score->total;
    entry.seconds = score->seconds;
  } else {
    entry.seconds = static_cast<double>(recording.last_step()) * recording.meta().dt;
  }
  return entry;
}

/// Length [s] of what is stored of a recording, from its last block of steps; 0 where it cannot be read.
double stored_seconds(const std::string& file) {
  try {
    const RecordingReader recording(file);
    return static_cast<double>(recording.last_step()) * recording.meta().dt;
  } catch (const InputError&) {
    return 0.0;  // check() names the damage
  }
}

/// Nothing of one that cannot be read: check() names the damage.
std::optional<StoreEntry> stored_entry(const std::string& file, const std::string& id) {
  try {
    return entry_of(RecordingReader(file), id);
  } catch (const InputError&) {
    return std::nullopt;
  }
}

StoreProblem damaged(const std::string& id, const std::string& what) {
  return {id, what, "keep the file: what stands beside the damage can be read"};
}

/// All damage of a recording in one sentence; empty: sound.
std::string damage_of(const RecordingReader& recording) {
  std::string all;
  for (const std::string& one : recording.find_damage()) all += (all.empty() ? "" : "; ") + one;
  return all;
}

std::vector<std::string> ids_in(const std::string& folder) {
  std::vector<std::string> ids;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error))
    if (it->path().extension() == kRecordingSuffix) ids.push_back(it->path().stem().string());
  std::sort(ids.begin(), ids.end());
  return ids;
}

}  // namespace

struct Store::Impl {
  std::string folder;
  bool own_index = false;  // the SQLite file in the folder, not a site's database
  std::unique_ptr<soci::session> sql;
  std::vector<StoreProblem> found_on_opening;

  void create_tables() {
    *sql << "CREATE TABLE IF NOT EXISTS filum_store (format INTEGER NOT NULL)";
    int rows = 0;
    *sql << "SELECT count(*) FROM filum_store", soci::into(rows);
    if (rows == 0) *sql << "INSERT INTO filum_store (format) VALUES (" << kStoreFormat << ")";
    *sql << "CREATE TABLE IF NOT EXISTS filum_sessions (id VARCHAR(200) PRIMARY KEY, task VARCHAR(100) NOT "
            "NULL, "
            "participant VARCHAR(32) NOT NULL, started_utc VARCHAR(32) NOT NULL, seconds DOUBLE PRECISION "
            "NOT NULL, "
            "finished INTEGER NOT NULL, scored INTEGER NOT NULL, passed INTEGER NOT NULL, "
            "total DOUBLE PRECISION NOT NULL)";
  }

  void check_format(const std::string& where) {
    int format = 0;
    *sql << "SELECT max(format) FROM filum_store", soci::into(format);
    if (format > kStoreFormat) throw_newer(where, format);
  }

  [[noreturn]] static void throw_newer(const std::string& where, int format) {
    throw StoreError(StoreTrouble::kNewer, where, "format", std::to_string(format) + ", made by a newer Filum",
                     "a format up to " + std::to_string(kStoreFormat));
  }

  void open_own_index() {
    const std::string file = index_path(folder).string();
    const bool there = fs::exists(file);
    const database::Header header = database::read_header(file);
    if (header.application_id == database::kIndexId && header.format > kStoreFormat) throw_newer(file, header.format);
    if (there) database::require_format(file, "the index of a Filum store", database::kIndexId, kStoreFormat);
    sql = std::make_unique<soci::session>(soci::sqlite3, database::connection_string(file, false));
    if (there && database::pragma(*sql, "quick_check") != "ok")
      throw InputError(file, "index", "damage", "an undamaged index");
    create_tables();
    if (!there) database::mark(*sql, database::kIndexId, kStoreFormat);
    check_format(file);
  }

  void put(const StoreEntry& entry) {
    Row row{entry, entry.finished ? 1 : 0, entry.scored ? 1 : 0, entry.passed ? 1 : 0};
    *sql << "INSERT INTO filum_sessions (" << kColumns
         << ") VALUES (:id, :task, :participant, :started, :seconds, :finished, :scored, :passed, :total)",
        soci::use(row.entry.id), soci::use(row.entry.task), soci::use(row.entry.participant),
        soci::use(row.entry.started_utc), soci::use(row.entry.seconds), soci::use(row.finished),
        soci::use(row.scored), soci::use(row.passed), soci::use(row.entry.total);
  }

  /// put(), unless another program that opened this store has just done so.
  void put_once(const StoreEntry& entry) {
    try {
      put(entry);
    } catch (const soci::soci_error&) {
      if (select("id = :a AND :b = ''", entry.id, "").empty()) throw;
    }
  }

  std::vector<StoreEntry> select(const std::string& condition, const std::string& a, const std::string& b) {
    std::vector<StoreEntry> entries;
    Row row;
    soci::statement query =
        (sql->prepare << "SELECT " << kColumns << " FROM filum_sessions WHERE " << condition
                      << " ORDER BY started_utc DESC, id DESC",
         soci::use(a, "a"), soci::use(b, "b"), soci::into(row.entry.id), soci::into(row.entry.task),
         soci::into(row.entry.participant), soci::into(row.entry.started_utc), soci::into(row.entry.seconds),
         soci::into(row.finished), soci::into(row.scored), soci::into(row.passed),
         soci::into(row.entry.total));
    query.execute();
    while (query.fetch()) entries.push_back(row.filled());
    return entries;
  }

  /// Sessions that a crash cut short, that still run, or that another program has ended since they were entered: as stored by now.
  void update_unfinished() {
    for (const StoreEntry& known : select("finished = 0 AND :a = '' AND :b = ''", "", "")) {
      const auto entry = stored_entry((fs::path(folder) / (known.id + kRecordingSuffix)).string(), known.id);
      if (!entry || (!entry->finished && entry->seconds == known.seconds)) continue;
      *sql << "DELETE FROM filum_sessions WHERE id = :id AND finished = 0", soci::use(known.id);
      put_once(*entry);
    }
  }

  [[noreturn]] void throw_trouble(const std::exception& error) const {
    const std::string why = database::reason(error);
    switch (database::failure_of(error)) {
      case database::Failure::kLocked:
        throw StoreError(StoreTrouble::kLocked, folder, "store", why, "a store that no other program keeps locked");
      case database::Failure::kNoRoom:
        throw StoreError(StoreTrouble::kNoRoom, folder, "store", why, "a disk with room that can be written");
      case database::Failure::kDamage:
      case database::Failure::kOther: break;
    }
    throw StoreError(StoreTrouble::kDatabase, folder, "store", why, "a store that can be read and written");
  }

  /// Runs a database action; its failures name the store.
  template <class Action>
  auto guarded(Action&& action) {
    try {
      return action();
    } catch (const soci::soci_error& error) {
      throw_trouble(error);
    }
  }
};

Store::Store(const std::string& folder, const std::string& index_connection)
    : impl_(std::make_unique<Impl>()) {
  impl_->folder = folder;
  impl_->own_index = index_connection.empty();
  std::error_code error;
  fs::create_directories(folder, error);
  if (!is_folder(folder)) throw StoreError(StoreTrouble::kNoFolder, folder, "store", error ? error.message() : "a file", "a folder");
  if (::access(folder.c_str(), W_OK | X_OK) != 0)
    throw StoreError(StoreTrouble::kNotWritable, folder, "store", "a folder that cannot be written",
                     "a folder that can be written");
  if (!impl_->own_index) {
    impl_->guarded([&] {
      impl_->sql = std::make_unique<soci::session>(index_connection);
      impl_->create_tables();
    });
    impl_->check_format("index");
    return;
  }
  bool damaged = false;
  try {
    impl_->open_own_index();
  } catch (const StoreError&) {
    throw;
  } catch (const InputError&) {
    damaged = true;
  } catch (const soci::soci_error& error) {
    if (database::failure_of(error) != database::Failure::kDamage) impl_->throw_trouble(error);
    damaged = true;
  }
  if (!damaged) {
    impl_->guarded([&] { impl_->update_unfinished(); });
    adopt();
    return;
  }
  impl_->sql.reset();
  const std::string aside = (fs::path(folder) / ("index-damaged-" + compact(utc_now()) + ".sqlite")).string();
  fs::rename(index_path(folder), aside, error);
  impl_->guarded([&] { impl_->open_own_index(); });
  impl_->found_on_opening = rebuild();
  impl_->found_on_opening.push_back({"index", "was damaged; set aside as " + aside,
                                     "nothing to do: it was built anew from the recordings"});
}

Store::~Store() = default;
Store::Store(Store&&) noexcept = default;

const std::string& Store::folder() const {
  return impl_->folder;
}

std::string Store::file_of(const std::string& id) const {
  return (fs::path(impl_->folder) / (id + kRecordingSuffix)).string();
}

StoreEntry Store::begin(const std::string& task, const std::string& participant) {
  if (!participant.empty() && !is_participant_code(participant))
    throw InputError("session", "participant", "\"" + participant + "\"",
                     "a code of 1 to 32 letters, digits, - or _ (never a name)");
  StoreEntry entry;
  entry.task = task;
  entry.participant = participant;
  entry.started_utc = utc_now();
  const std::string base =
      compact(entry.started_utc) + "-" + word(task) + (participant.empty() ? "" : "-" + participant);
  entry.id = base;
  for (int n = 2; fs::exists(file_of(entry.id)) || find(entry.id); ++n)
    entry.id = base + "-" + std::to_string(n);
  impl_->guarded([&] { impl_->put(entry); });
  return entry;
}

void Store::finish(const std::string& id, const std::optional<ScoreRecord>& score) {
  const int scored = score ? 1 : 0;
  const int passed = score && score->passed ? 1 : 0;
  const double total = score ? score->total : 0.0;
  const double seconds = score ? score->seconds : stored_seconds(file_of(id));
  impl_->guarded([&] {
    *impl_->sql
        << "UPDATE filum_sessions SET finished = 1, scored = :s, passed = :p, total = :t, seconds = :sec "
           "WHERE id = :id",
        soci::use(scored), soci::use(passed), soci::use(total), soci::use(seconds), soci::use(id);
  });
}

std::vector<StoreEntry> Store::list(const std::string& task, const std::string& participant) const {
  return impl_->guarded([&] {
    return impl_->select(std::string(task.empty() ? ":a = ''" : "task = :a") + " AND " +
                             (participant.empty() ? ":b = ''" : "participant = :b"),
                         task, participant);
  });
}

std::optional<StoreEntry> Store::find(const std::string& id) const {
  return impl_->guarded([&]() -> std::optional<StoreEntry> {
    const std::vector<StoreEntry> found = impl_->select("id = :a AND :b = ''", id, "");
    if (found.empty()) return std::nullopt;
    return found.front();
  });
}

void Store::adopt() {
  for (const std::string& id : ids_in(impl_->folder)) {
    if (find(id)) continue;
    try {
      const StoreEntry entry = entry_of(RecordingReader(file_of(id)), id);
      impl_->guarded([&] { impl_->put_once(entry); });
    } catch (const StoreError&) {
      throw;
    } catch (const InputError&) {  // check() names the damage
    }
  }
}

std::vector<StoreProblem> Store::rebuild() {
  std::vector<StoreProblem> problems;
  std::vector<StoreEntry> entries;
  for (const std::string& id : ids_in(impl_->folder)) {
    try {
      const RecordingReader recording(file_of(id));
      entries.push_back(entry_of(recording, id));
      if (const std::string damage = damage_of(recording); !damage.empty()) problems.push_back(damaged(id, damage));
    } catch (const InputError& error) {
      problems.push_back(damaged(id, error.what()));
    }
  }
  impl_->guarded([&] {
    soci::transaction transaction(*impl_->sql);
    *impl_->sql << "DELETE FROM filum_sessions";
    for (const StoreEntry& entry : entries) impl_->put(entry);
    transaction.commit();
  });
  return problems;
}

std::vector<StoreProblem> Store::check(bool deep) const {
  std::vector<StoreProblem> problems = impl_->found_on_opening;
  const std::vector<std::string> ids = ids_in(impl_->folder);
  for (const std::string& id : ids) {
    try {
      const RecordingReader recording(file_of(id));
      if (!find(id)) problems.push_back({id, "is not in the index", "nothing to do: it is entered when the store is next opened"});
      if (const std::string damage = deep ? damage_of(recording) : ""; !damage.empty()) problems.push_back(damaged(id, damage));
    } catch (const InputError& error) {
      problems.push_back(damaged(id, error.what()));
    }
  }
  for (const StoreEntry& entry : list())
    if (!std::binary_search(ids.begin(), ids.end(), entry.id))
      problems.push_back(
          {entry.id, "is in the index but its file is gone", "restore the file"});
  return problems;
}

std::string default_store_folder() {
  if (const char* folder = std::getenv("FILUM_STORE"); folder != nullptr && *folder != '\0') return folder;
  if (const char* data = std::getenv("XDG_DATA_HOME"); data != nullptr && *data != '\0')
    return (fs::path(data) / "filum").string();
  const char* home = std::getenv("HOME");
  return (fs::path(home != nullptr && *home != '\0' ? home : ".") / ".local/share/filum").string();
}

}  // namespace filum
