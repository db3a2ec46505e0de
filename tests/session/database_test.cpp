#include "session/database.h"

#include <gtest/gtest.h>
#include <soci/sqlite3/soci-sqlite3.h>

#include <fstream>

#include "base/error.h"
#include "tests/session/synthetic.h"

namespace filum {
namespace database_test {

using synthetic::Folder;

TEST(Database, PathsWithBlanksOpenAndQuotationMarksAreRefused) {
  const Folder folder;
  const std::string file = folder.file("with  two blanks = and more");
  {
    soci::session sql(soci::sqlite3, database::connection_string(file, false));
    database::mark(sql, 77, 3);
  }
  EXPECT_TRUE(std::filesystem::exists(file));
  const database::Header header = database::read_header(file);
  EXPECT_TRUE(header.is_sqlite);
  EXPECT_EQ(header.application_id, 77);
  EXPECT_EQ(header.format, 3);
  EXPECT_THROW(database::connection_string("a\"b", false), InputError);
  EXPECT_THROW(database::connection_string("", false), InputError);
}

TEST(Database, ReadOnlyConnectionsDoNotCreateNorWrite) {
  const Folder folder;
  EXPECT_THROW(soci::session(soci::sqlite3, database::connection_string(folder.file("none"), true)),
               soci::soci_error);
  EXPECT_FALSE(std::filesystem::exists(folder.file("none")));
}

TEST(Database, RequireFormatTellsWhatIsWrong) {
  const Folder folder;
  const auto field_of = [&](const std::string& file) {
    try {
      database::require_format(file, "a test", 77, 2);
    } catch (const InputError& error) {
      return error.field + " " + error.value;
    }
    return std::string("fine");
  };
  EXPECT_EQ(field_of(folder.file("none")), "file nothing that can be read");
  EXPECT_EQ(field_of(folder.path().string()), "file nothing that can be read");
  std::ofstream(folder.file("text")) << "hello";
  EXPECT_EQ(field_of(folder.file("text")), "file another kind of file");
  for (const int format : {0, 1, 2, 3}) {
    const std::string file = folder.file("db" + std::to_string(format));
    soci::session sql(soci::sqlite3, database::connection_string(file, false));
    database::mark(sql, 77, format);
    const std::string said = field_of(file);
    if (format == 0) {
      EXPECT_EQ(said, "format 0");
    }
    if (format == 1 || format == 2) {
      EXPECT_EQ(said, "fine");
    }
    if (format == 3) {
      EXPECT_EQ(said, "format 3, made by a newer Filum");
    }
  }
}

TEST(Database, BlobsCarryAnyBytes) {
  soci::session sql(soci::sqlite3, database::connection_string(":memory:", false));
  sql << "CREATE TABLE t (data BLOB)";
  for (const std::vector<char>& bytes :
       {std::vector<char>{'a', '\0', '\xFF'}, std::vector<char>(100000, '\x01')}) {
    soci::blob in(sql);
    database::set_bytes(in, bytes);
    sql << "DELETE FROM t";
    sql << "INSERT INTO t (data) VALUES (:d)", soci::use(in);
    soci::blob out(sql);
    sql << "SELECT data FROM t", soci::into(out);
    EXPECT_EQ(database::bytes_of(out), bytes);
  }
}

TEST(Database, DamageIsToldFromALockAndFromWantOfRoom) {
  const Folder folder;
  const auto failure_of = [](soci::session& sql, const std::string& statement) {
    try {
      sql << statement;
    } catch (const soci::soci_error& error) {
      return database::failure_of(error);
    }
    ADD_FAILURE() << "no failure";
    return database::Failure::kOther;
  };
  const std::string file = folder.file("db");
  soci::session sql(soci::sqlite3, database::connection_string(file, false));
  sql << "CREATE TABLE t (a TEXT)";
  EXPECT_EQ(failure_of(sql, "SELECT b FROM nowhere"), database::Failure::kOther);
  sql << "PRAGMA max_page_count = 2";
  EXPECT_EQ(failure_of(sql, "INSERT INTO t (a) VALUES (hex(zeroblob(20000)))"), database::Failure::kNoRoom);
  {
    soci::session other(soci::sqlite3, "dbname=\"" + file + "\" timeout=0");
    sql << "BEGIN EXCLUSIVE";
    EXPECT_EQ(failure_of(other, "SELECT count(*) FROM t"), database::Failure::kLocked);
    sql << "ROLLBACK";
  }
  std::ofstream(folder.file("text")) << std::string(4096, 'x');
  soci::session text(soci::sqlite3, database::connection_string(folder.file("text"), false));
  EXPECT_EQ(failure_of(text, "CREATE TABLE t (a TEXT)"), database::Failure::kDamage);
  EXPECT_EQ(database::failure_of(std::runtime_error("something else")), database::Failure::kOther);
}

TEST(Database, ReasonsLeaveOutTheStatement) {
  soci::session sql(soci::sqlite3, database::connection_string(":memory:", false));
  try {
    sql << "SELECT 1 FROM nowhere";
    FAIL();
  } catch (const soci::soci_error& error) {
    EXPECT_EQ(database::reason(error), "no such table: nowhere");
  }
}

}  // namespace database_test
}  // namespace filum
