#pragma once
// A folder of recordings with an index. The index is a convenience that can be rebuilt from the recordings at
// any time; by default it is an SQLite file in the folder, another SOCI connection string may be given.
// Participants are codes, never names.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "session/records.h"

namespace filum {

inline constexpr int kStoreFormat = 1;
inline constexpr const char* kRecordingSuffix = ".filum-session";

struct StoreEntry {
  std::string id;  // also the file's name without suffix
  std::string task;
  std::string participant;  // code or empty
  std::string started_utc;
  double seconds = 0.0;   // [s], of the task; without a score, of what was stored
  bool finished = false;  // closed properly; else cut short, or still running
  bool scored = false;
  bool passed = false;
  double total = 0.0;  // [points]
};

struct StoreProblem {
  std::string id;  // recording or "index"
  std::string what;
  std::string advice;
};

/// Why a store cannot be opened: each asks for something else of the user.
enum class StoreTrouble { kNoFolder, kNotWritable, kNewer, kLocked, kNoRoom, kDatabase };

struct StoreError : InputError {
  StoreError(StoreTrouble trouble, const std::string& file, const std::string& field, const std::string& value,
             const std::string& expected)
      : InputError(file, field, value, expected), trouble(trouble) {}
  StoreTrouble trouble;
};

class Store {
 public:
  /// Opens or creates. A damaged index is set aside, built anew from the recordings, and reported by check(). Recordings that
  /// the index does not know (it is gone, or they were copied into the folder) are entered.
  /// Sessions that were cut short get the length of what was stored of them. Throws StoreError when the folder cannot
  /// be made or written, the index was made by a newer program, or is sound but locked or without room.
  /// Not thread-safe: one thread owns a Store.
  explicit Store(const std::string& folder, const std::string& index_connection = "");
  ~Store();
  Store(Store&&) noexcept;

  const std::string& folder() const;

  /// A new id and its file for a recording that is about to start; entered in the index as unfinished.
  StoreEntry begin(const std::string& task, const std::string& participant);
  /// Enters how it ended.
  void finish(const std::string& id, const std::optional<ScoreRecord>& score);

  /// Newest first; empty task or participant means all.
  std::vector<StoreEntry> list(const std::string& task = "", const std::string& participant = "") const;
  std::optional<StoreEntry> find(const std::string& id) const;
  std::string file_of(const std::string& id) const;

  /// Reads every recording in the folder and writes the index anew. Damaged files are left alone and
  /// reported; those that can be read in part are entered.
  std::vector<StoreProblem> rebuild();
  /// Compares folder and index without changing either; `deep` also reads every block of every recording.
  std::vector<StoreProblem> check(bool deep) const;

 private:
  struct Impl;
  void adopt();
  std::unique_ptr<Impl> impl_;
};

/// Where recordings go unless told otherwise: $FILUM_STORE, else $XDG_DATA_HOME/filum, else
/// ~/.local/share/filum.
std::string default_store_folder();

}  // namespace filum
