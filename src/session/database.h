#pragma once
// The few things about SQLite that SOCI leaves to its user. Private to the session layer.

#include <soci/soci.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace filum::database {

inline constexpr std::int32_t kRecordingId = 0x46694C6D;  // "FiLm": SQLite's application_id of a recording
inline constexpr std::int32_t kIndexId = 0x46694C78;      // of a store's index

/// SOCI connection string for a file. Throws InputError for a path that cannot be written as one.
std::string connection_string(const std::string& file, bool read_only);

/// What the first bytes of a file say, without opening it as a database.
struct Header {
  bool exists = false;
  bool is_sqlite = false;
  std::int32_t application_id = 0;
  std::int32_t format = 0;
};
Header read_header(const std::string& file);

/// Throws InputError unless the file is a database of ours (`what`, with this application id) that this
/// program can read.
void require_format(const std::string& file, const std::string& what, std::int32_t application_id,
                    int newest_format);

/// Writes application id and format.
void mark(soci::session& sql, std::int32_t application_id, int format);

/// "PRAGMA ..." with one value as the answer.
std::string pragma(soci::session& sql, const std::string& text);

/// What kind of trouble a database's error is; only damage is a reason to build anything anew.
enum class Failure { kDamage, kLocked, kNoRoom, kOther };
Failure failure_of(const std::exception& error) noexcept;

/// SOCI's messages carry the failed statement; people need the reason only.
std::string reason(const std::exception& error);

std::vector<char> bytes_of(soci::blob& blob);
void set_bytes(soci::blob& blob, std::span<const char> bytes);

}  // namespace filum::database
