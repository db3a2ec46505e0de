#include "session/database.h"

#include <soci/sqlite3/soci-sqlite3.h>

#include <array>
#include <filesystem>
#include <fstream>

#include "base/error.h"

namespace filum::database {
namespace {

std::int32_t big_endian(const unsigned char* bytes) {
  std::uint32_t value = 0;
  for (int i = 0; i < 4; ++i) value = value << 8 | bytes[i];
  return static_cast<std::int32_t>(value);
}

}  // namespace

std::string connection_string(const std::string& file, bool read_only) {
  if (file.empty() || file.find('"') != std::string::npos || file.starts_with("file:"))
    throw InputError(file, "file", "this name", "a path without quotation marks");
  return "dbname=\"" + file + "\" timeout=5" + (read_only ? " readonly=true" : "");
}

Header read_header(const std::string& file) {
  Header header;
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return header;
  std::ifstream stream(file, std::ios::binary);
  std::array<char, 100> bytes{};
  header.exists = static_cast<bool>(stream);
  stream.read(bytes.data(), bytes.size());
  const auto* unsigned_bytes = reinterpret_cast<const unsigned char*>(bytes.data());
  header.is_sqlite =
      stream.gcount() == bytes.size() && std::string_view(bytes.data(), 15) == "SQLite format 3";
  if (header.is_sqlite) {
    header.format = big_endian(unsigned_bytes + 60);
    header.application_id = big_endian(unsigned_bytes + 68);
  }
  return header;
}

void require_format(const std::string& file, const std::string& what, std::int32_t application_id,
                    int newest_format) {
  const Header header = read_header(file);
  if (!header.exists) throw InputError(file, "file", "nothing that can be read", what);
  if (!header.is_sqlite || header.application_id != application_id)
    throw InputError(file, "file", "another kind of file", what);
  if (header.format > newest_format)
    throw InputError(file, "format", std::to_string(header.format) + ", made by a newer Filum",
                     "a format up to " + std::to_string(newest_format));
  if (header.format < 1) throw InputError(file, "format", std::to_string(header.format), "1 or more");
}

void mark(soci::session& sql, std::int32_t application_id, int format) {
  sql << "PRAGMA application_id = " << application_id;
  sql << "PRAGMA user_version = " << format;
}

std::string pragma(soci::session& sql, const std::string& text) {
  std::string answer;
  soci::indicator known = soci::i_null;
  sql << "PRAGMA " << text, soci::into(answer, known);
  return known == soci::i_ok ? answer : "";
}

Failure failure_of(const std::exception& error) noexcept {
  const auto* known = dynamic_cast<const soci::sqlite3_soci_error*>(&error);
  if (known == nullptr) return Failure::kOther;
  switch (known->result() & 0xff) {  // the higher bytes only say more
    case SQLITE_CORRUPT:
    case SQLITE_NOTADB: return Failure::kDamage;
    case SQLITE_BUSY:
    case SQLITE_LOCKED: return Failure::kLocked;
    case SQLITE_FULL: return Failure::kNoRoom;
    default: return Failure::kOther;
  }
}

std::string reason(const std::exception& error) {
  std::string text = error.what();
  if (const std::size_t at = text.find(" while "); at != std::string::npos) text.erase(at);
  for (const std::string_view prefix :
       {"sqlite3_statement_backend::loadOne: ", "sqlite3_statement_backend::prepare: ",
        "Cannot establish connection to the database. "})
    if (text.starts_with(prefix)) text.erase(0, prefix.size());
  return text;
}

std::vector<char> bytes_of(soci::blob& blob) {
  std::vector<char> bytes(blob.get_len());
  if (!bytes.empty()) bytes.resize(blob.read(0, bytes.data(), bytes.size()));
  return bytes;
}

void set_bytes(soci::blob& blob, std::span<const char> bytes) {
  blob.trim(0);
  if (!bytes.empty()) blob.write(0, bytes.data(), bytes.size());
}

}  // namespace filum::database
