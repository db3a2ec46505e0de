#include "session/store.h"

#include <gtest/gtest.h>
#include <soci/sqlite3/soci-sqlite3.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>

#include "base/error.h"
#include "session/database.h"
#include "tests/session/disk_limit.h"
#include "tests/session/synthetic.h"

namespace filum {
namespace store_test {

using synthetic::Folder;

StoreEntry record_one(Store& store, const std::string& participant, bool scored = true) {
  const StoreEntry entry = store.begin("knot-square", participant);
  synthetic::write_recording(store.file_of(entry.id), 60, scored);
  store.finish(entry.id, scored ? std::optional<ScoreRecord>({true, 87.5, 12.25, "{}"}) : std::nullopt);
  return entry;
}

TEST(Store, KeepsAnIndexOfWhatWasRecorded) {
  const Folder folder;
  Store store(folder.file("deep/store"));
  const StoreEntry first = record_one(store, "A17");
  const StoreEntry second = record_one(store, "A17");
  const StoreEntry other = store.begin("knot-surgeons", "B2");
  EXPECT_NE(first.id, second.id);
  EXPECT_EQ(store.list().size(), 3u);
  EXPECT_EQ(store.list("knot-square").size(), 2u);
  EXPECT_EQ(store.list("", "B2").size(), 1u);
  EXPECT_EQ(store.list("knot-square", "B2").size(), 0u);
  const auto found = store.find(first.id);
  ASSERT_TRUE(found.has_value());
  EXPECT_TRUE(found->finished && found->scored && found->passed);
  EXPECT_EQ(found->total, 87.5);
  EXPECT_EQ(found->seconds, 12.25);
  EXPECT_FALSE(store.find(other.id)->finished);
  EXPECT_FALSE(store.find("none").has_value());
}

TEST(Store, IsThereAgainWhenOpenedAgain) {
  const Folder folder;
  std::string id;
  {
    Store store(folder.file("s"));
    id = record_one(store, "A17").id;
  }
  const Store store(folder.file("s"));
  EXPECT_TRUE(store.find(id).has_value());
  EXPECT_TRUE(store.check(true).empty());
}

TEST(Store, RefusesNamesAndQuotesNothing) {
  const Folder folder;
  Store store(folder.file("s"));
  EXPECT_THROW(store.begin("knot-square", "Jane Doe"), InputError);
  EXPECT_THROW(store.begin("knot-square", "'; DROP TABLE filum_sessions; --"), InputError);
  EXPECT_TRUE(store.list("'; DROP TABLE filum_sessions; --").empty());
  EXPECT_TRUE(store.list().empty());
  const StoreEntry odd = store.begin("../../etc/x", "");
  EXPECT_EQ(std::filesystem::path(store.file_of(odd.id)).parent_path(),
            std::filesystem::path(folder.file("s")));
}

TEST(Store, ADamagedIndexIsBuiltAnewFromTheRecordings) {
  const Folder folder;
  std::string id;
  {
    Store store(folder.file("s"));
    id = record_one(store, "A17").id;
  }
  std::ofstream(folder.file("s/index.sqlite"), std::ios::binary | std::ios::trunc) << "rubbish";
  Store store(folder.file("s"));
  const auto found = store.find(id);
  ASSERT_TRUE(found.has_value());
  EXPECT_EQ(found->participant, "A17");
  EXPECT_EQ(found->total, 87.5);
  EXPECT_TRUE(found->finished);
  ASSERT_EQ(store.check(false).size(), 1u);
  EXPECT_NE(store.check(false)[0].what.find("damaged"), std::string::npos);
}

TEST(Store, RecordingsThatTheIndexDoesNotKnowAreEnteredOnOpening) {
  const Folder folder;
  std::string id;
  {
    Store store(folder.file("s"));
    id = record_one(store, "A17").id;
  }
  std::filesystem::remove(folder.file("s/index.sqlite"));
  {
    const Store store(folder.file("s"));
    ASSERT_TRUE(store.find(id).has_value()) << "the index was gone";
    EXPECT_EQ(store.find(id)->participant, "A17");
    EXPECT_EQ(store.find(id)->total, 87.5);
    EXPECT_TRUE(store.check(false).empty());
  }
  std::filesystem::copy_file(folder.file("s/" + id + ".filum-session"), folder.file("s/from-another-machine.filum-session"));
  std::ofstream(folder.file("s/rubbish.filum-session")) << "rubbish";
  const Store store(folder.file("s"));
  EXPECT_TRUE(store.find("from-another-machine").has_value());
  EXPECT_FALSE(store.find("rubbish").has_value());
  EXPECT_EQ(store.list().size(), 2u);
  ASSERT_EQ(store.check(false).size(), 1u);
  EXPECT_EQ(store.check(false)[0].id, "rubbish");
}

TEST(Store, AnIndexFromANewerProgramIsRefusedAndLeftAlone) {
  const Folder folder;
  { Store store(folder.file("s")); }
  {
    soci::session sql(soci::sqlite3, database::connection_string(folder.file("s/index.sqlite"), false));
    sql << "PRAGMA user_version = 9";
  }
  try {
    Store store(folder.file("s"));
    FAIL() << "a newer index was taken";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("made by a newer Filum"), std::string::npos) << error.what();
  }
  EXPECT_EQ(database::read_header(folder.file("s/index.sqlite")).format, 9);
}

TEST(Store, AnIndexWithoutAFormatIsBuiltAnew) {
  const Folder folder;
  {
    Store store(folder.file("s"));
    record_one(store, "A17");
  }
  {
    soci::session sql(soci::sqlite3, database::connection_string(folder.file("s/index.sqlite"), false));
    sql << "PRAGMA user_version = 0";
  }
  const Store store(folder.file("s"));
  EXPECT_EQ(store.list().size(), 1u);
  EXPECT_EQ(database::read_header(folder.file("s/index.sqlite")).format, kStoreFormat);
}

TEST(Store, CheckFindsWhatIsMissingAndWhatIsDamaged) {
  const Folder folder;
  Store store(folder.file("s"));
  const std::string gone = record_one(store, "A1").id;
  const std::string damaged = record_one(store, "A2").id;
  record_one(store, "A3");
  std::filesystem::remove(store.file_of(gone));
  std::filesystem::resize_file(store.file_of(damaged), 9000);
  synthetic::write_recording(store.file_of("stray"), 20);
  std::vector<std::string> ids;
  for (const StoreProblem& problem : store.check(true)) ids.push_back(problem.id);
  std::sort(ids.begin(), ids.end());
  std::vector<std::string> expected{gone, damaged, "stray"};
  std::sort(expected.begin(), expected.end());
  EXPECT_EQ(ids, expected);
  const std::vector<StoreProblem> problems = store.rebuild();
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_EQ(problems[0].id, damaged);
  EXPECT_TRUE(store.find("stray").has_value());
  EXPECT_FALSE(store.find(gone).has_value());
}

TEST(Store, RebuildGivesUnscoredSessionsTheirLength) {
  const Folder folder;
  Store store(folder.file("s"));
  synthetic::write_recording(store.file_of("x"), 500, false);
  EXPECT_TRUE(store.rebuild().empty());
  EXPECT_NEAR(store.find("x")->seconds, 1.0, 1e-12);
  EXPECT_FALSE(store.find("x")->scored);
}

/// Of another program that records into the store, or of one that was killed before it told the store.
TEST(Store, SessionsThatWereLeftUnfinishedAreReadAnewOnOpening) {
  const Folder folder;
  std::string id, empty, scored;
  {
    Store store(folder.file("s"));
    id = store.begin("knot-square", "").id;
    empty = store.begin("knot-square", "B").id;
    scored = store.begin("knot-square", "C").id;
    synthetic::write_recording(store.file_of(id), 500, false);
    synthetic::write_recording(store.file_of(scored), 500);
    EXPECT_EQ(store.find(id)->seconds, 0.0);
  }  // killed before finish()
  Store store(folder.file("s"));
  EXPECT_NEAR(store.find(id)->seconds, 1.0, 1e-12);
  EXPECT_FALSE(store.find(id)->scored);
  EXPECT_EQ(store.find(empty)->seconds, 0.0);
  EXPECT_FALSE(store.find(empty)->finished);
  EXPECT_TRUE(store.find(scored)->finished);
  EXPECT_EQ(store.find(scored)->total, 87.5);
  store.finish(id, std::nullopt);
  EXPECT_NEAR(store.find(id)->seconds, 1.0, 1e-12) << "ended without a score";
}

TEST(Store, ARecordingThatIsDamagedInPartIsEnteredAndReported) {
  const Folder folder;
  Store store(folder.file("s"));
  const std::string id = record_one(store, "A1").id;
  {
    soci::session sql(soci::sqlite3, database::connection_string(store.file_of(id), false));
    sql << "UPDATE events SET hash = hash + 1";
  }
  const auto problems = store.rebuild();
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_EQ(problems[0].what, "events block 1 with a wrong checksum");
  EXPECT_EQ(store.find(id)->total, 87.5);
}

/// What opening a store said, and whether its index still is the file it was.
void expect_left_alone(const std::string& folder, StoreTrouble trouble) {
  try {
    Store store(folder);
    FAIL() << "opened";
  } catch (const StoreError& error) {
    EXPECT_EQ(error.trouble, trouble) << error.what();
  }
  for (const auto& file : std::filesystem::directory_iterator(folder)) EXPECT_EQ(file.path().string().find("damaged"), std::string::npos) << file.path();
}

TEST(Store, ALockedIndexIsNotTakenForADamagedOne) {
  const Folder folder;
  std::string id;
  {
    Store store(folder.file("s"));
    id = record_one(store, "A17").id;
  }
  {
    soci::session other(soci::sqlite3, database::connection_string(folder.file("s/index.sqlite"), false));
    other << "BEGIN EXCLUSIVE";
    expect_left_alone(folder.file("s"), StoreTrouble::kLocked);
  }
  EXPECT_TRUE(Store(folder.file("s")).find(id).has_value());
}

TEST(Store, AnIndexThatCannotGrowIsNotTakenForADamagedOne) {
  const Folder folder;
  { Store store(folder.file("s")); }
  std::filesystem::remove(folder.file("s/index.sqlite"));
  {
    const DiskLimit full(0);
    expect_left_alone(folder.file("s"), StoreTrouble::kDatabase);
  }
}

TEST(Store, RefusesAFolderItCannotWrite) {
  const Folder folder;
  std::ofstream(folder.file("file")) << "x";
  EXPECT_THROW(Store(folder.file("file")), InputError);
  EXPECT_THROW(Store(folder.file("file/below")), InputError);
  std::filesystem::create_directory(folder.file("locked"));
  std::filesystem::permissions(folder.path(), std::filesystem::perms(0755));
  std::filesystem::permissions(folder.file("locked"), std::filesystem::perms(0555));
  // access() asks for the real user, so both ids change here.
  if (::geteuid() == 0) {
    ASSERT_EQ(::setresuid(65534, 65534, 0), 0);
  }
  EXPECT_THROW(Store(folder.file("locked")), InputError);
  if (::geteuid() == 65534) {
    ASSERT_EQ(::setresuid(0, 0, 0), 0);
  }
}

TEST(Store, TheDefaultFolderFollowsTheEnvironment) {
  ::setenv("FILUM_STORE", "/a/b", 1);
  EXPECT_EQ(default_store_folder(), "/a/b");
  ::unsetenv("FILUM_STORE");
  ::setenv("XDG_DATA_HOME", "/data", 1);
  EXPECT_EQ(default_store_folder(), "/data/filum");
  ::unsetenv("XDG_DATA_HOME");
  ::setenv("HOME", "/home/x", 1);
  EXPECT_EQ(default_store_folder(), "/home/x/.local/share/filum");
}

}  // namespace store_test
}  // namespace filum
