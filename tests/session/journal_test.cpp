// A log as SQLite writes it, whole, cut and with a bit flipped anywhere: whatever SQLite leaves out in the middle is told, whatever a kill leaves is not.

#include "session/journal.h"

#include <gtest/gtest.h>
#include <soci/sqlite3/soci-sqlite3.h>

#include <fstream>

#include "base/rng.h"
#include "session/database.h"
#include "tests/session/synthetic.h"

namespace filum {
namespace journal_test {

using synthetic::Folder;

constexpr std::size_t kPage = 4096, kFrame = kPage + 24, kHead = 32;
constexpr int kRows = 40;

std::string bytes_of(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

void write_bytes(const std::string& file, const std::string& bytes) { std::ofstream(file, std::ios::binary | std::ios::trunc) << bytes; }

/// A database and its log of kRows commits, copied while it is open.
void write_database(const Folder& folder) {
  soci::session sql(soci::sqlite3, database::connection_string(folder.file("live"), false));
  database::pragma(sql, "page_size = 4096");
  database::pragma(sql, "journal_mode = WAL");
  sql << "CREATE TABLE t (x TEXT)";
  for (int i = 0; i < kRows; ++i) sql << "INSERT INTO t VALUES ('" << std::string(1000, static_cast<char>('a' + i % 26)) << "')";
  for (const char* part : {"", "-wal"}) std::filesystem::copy_file(folder.file("live") + part, folder.file("a") + part);
}

/// How many rows SQLite finds with this log.
int rows_with(const Folder& folder, const std::string& log) {
  for (const char* part : {"", "-wal", "-shm"}) std::filesystem::remove(folder.file("b") + part);
  std::filesystem::copy_file(folder.file("a"), folder.file("b"));
  write_bytes(folder.file("b-wal"), log);
  soci::session sql(soci::sqlite3, database::connection_string(folder.file("b"), true));
  int rows = 0;
  int tables = 0;
  sql << "SELECT count(*) FROM sqlite_master", soci::into(tables);
  if (tables > 0) sql << "SELECT count(*) FROM t", soci::into(rows);
  return rows;
}

TEST(Journal, ALogThatJustEndsIsNotDamaged) {
  const Folder folder;
  write_database(folder);
  const std::string log = bytes_of(folder.file("a-wal"));
  EXPECT_EQ(rows_with(folder, log), kRows);
  EXPECT_EQ(journal_damage(folder.file("none")), "");
  for (std::size_t size = 0; size <= log.size(); size += 1009) {
    write_bytes(folder.file("cut"), log.substr(0, size));
    EXPECT_EQ(journal_damage(folder.file("cut")), "") << size << " of " << log.size();
  }
  write_bytes(folder.file("whole"), log);
  EXPECT_EQ(journal_damage(folder.file("whole")), "");
}

TEST(Journal, WhatSqliteLeavesOutIsTold) {
  const Folder folder;
  write_database(folder);
  const std::string log = bytes_of(folder.file("a-wal"));
  ASSERT_EQ((log.size() - kHead) % kFrame, 0u);
  Rng rng(11);
  int told = 0;
  for (int i = 0; i < 150; ++i) {
    std::string flipped = log;
    const std::size_t at = i < 20 ? rng.below(kHead) : rng.below(log.size());
    flipped[at] = static_cast<char>(flipped[at] ^ (1 << rng.below(8)));
    write_bytes(folder.file("flipped"), flipped);
    const bool lost = rows_with(folder, flipped) < kRows, last = at >= log.size() - kFrame;
    const bool said = !journal_damage(folder.file("flipped")).empty();
    EXPECT_TRUE(said == lost || last) << "byte " << at << (lost ? " loses rows" : " loses nothing");
    told += said ? 1 : 0;
  }
  EXPECT_GT(told, 100);
}

}  // namespace journal_test
}  // namespace filum
