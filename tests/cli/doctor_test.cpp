// filum doctor: every check says what it found, and what to do where it is not content. Cores, timer and speed depend on the machine.

#include <gtest/gtest.h>
#include <soci/sqlite3/soci-sqlite3.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <map>

#include "program_call.h"
#include "session/database.h"
#include "session/store.h"
#include "tests/devices/simulated_handle.h"
#include "tests/session/synthetic.h"

namespace filum {
namespace doctor_test {

using Json = nlohmann::ordered_json;

class Doctor : public testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directory(folder_.file("viewer"));
    std::ofstream(folder_.file("viewer/index.html")) << "<title>Filum</title>";
  }
  /// Checks by name.
  std::map<std::string, Json> checks(const std::vector<std::string>& more = {}, const char* store = "store", const char* viewer = "viewer") {
    std::vector<std::string> words = {"doctor", "--json", "--store", folder_.file(store), "--viewer", folder_.file(viewer)};
    words.insert(words.end(), more.begin(), more.end());
    const Call c = call(words);
    const Json d = Json::parse(c.out);
    std::map<std::string, Json> by_name;
    bool ok = true;
    for (const Json& check : d["checks"]) {
      expect_keys(check, {"name", "ok", "detail", "advice"});
      EXPECT_EQ(check["ok"].get<bool>(), check["advice"].get<std::string>().empty()) << check;
      EXPECT_FALSE(check["detail"].get<std::string>().empty()) << check;
      ok = ok && check["ok"].get<bool>();
      by_name[check["name"]] = check;
    }
    EXPECT_EQ(d["ok"].get<bool>(), ok);
    EXPECT_EQ(c.code, ok ? kDone : kFailed);
    return by_name;
  }
  synthetic::Folder folder_;
};

TEST_F(Doctor, EveryCheckIsThereAndWhatThisTestMadeIsFoundSound) {
  auto found = checks();
  for (const char* name : {"cores", "timer", "speed", "devices", "store", "viewer", "files", "versions"}) EXPECT_TRUE(found.count(name)) << name;
  for (const char* name : {"store", "viewer", "files", "versions"}) EXPECT_TRUE(found[name]["ok"].get<bool>()) << found[name];
  EXPECT_EQ(found.count("handle"), 0u);
  const std::string speed = found["speed"]["detail"];
  EXPECT_EQ(speed.find("first throw of knot-square, "), 0u) << "a thread that is handled, not one that lies there: " << speed;
  EXPECT_NE(speed.find("times real time"), std::string::npos) << speed;
}

TEST_F(Doctor, SessionsThatWereCutShortAreCounted) {
  {
    Store store(folder_.file("store"));
    store.finish(store.begin("knot-square", "").id, std::nullopt);
    store.begin("knot-square", "");
  }
  const std::string detail = checks()["store"]["detail"];
  EXPECT_NE(detail.find("2 sessions (1 cut short or running)"), std::string::npos) << detail;
}

TEST_F(Doctor, ALockedStoreIsCalledLocked) {
  { const Store store(folder_.file("store")); }
  soci::session other(soci::sqlite3, database::connection_string(folder_.file("store/index.sqlite"), false));
  other << "BEGIN EXCLUSIVE";
  const Json found = checks()["store"];
  EXPECT_NE(found["advice"].get<std::string>().find("End the other program"), std::string::npos) << found;
}

TEST_F(Doctor, WhatIsMissingIsSaidWithAdvice) {
  std::ofstream(folder_.file("file")) << "no folder";
  auto found = checks({"--root", folder_.file("empty"), "--serial", folder_.file("port")}, "file", "none");
  for (const char* name : {"store", "viewer", "files", "speed", "devices", "handle"}) EXPECT_FALSE(found[name]["ok"].get<bool>()) << name;
  EXPECT_NE(found["store"]["advice"].get<std::string>().find("--store"), std::string::npos);
  EXPECT_NE(found["viewer"]["advice"].get<std::string>().find("./filum"), std::string::npos);
  EXPECT_NE(found["files"]["advice"].get<std::string>().find("--root"), std::string::npos);
  EXPECT_NE(found["devices"]["detail"].get<std::string>().find(folder_.file("port")), std::string::npos);
}

TEST_F(Doctor, AStoreOfANewerProgramIsNotCalledUnwritable) {
  std::filesystem::create_directory(folder_.file("store"));
  {
    soci::session sql(soci::sqlite3, database::connection_string(folder_.file("store/index.sqlite"), false));
    sql << "CREATE TABLE filum_store (format INTEGER NOT NULL)";
    database::mark(sql, database::kIndexId, kStoreFormat + 1);
  }
  const Json found = checks()["store"];
  EXPECT_FALSE(found["ok"].get<bool>());
  EXPECT_NE(found["detail"].get<std::string>().find("made by a newer Filum"), std::string::npos) << found;
  EXPECT_NE(found["advice"].get<std::string>().find("newer Filum"), std::string::npos) << found;
  EXPECT_EQ(found["advice"].get<std::string>().find("may write"), std::string::npos) << found;
  EXPECT_EQ(database::read_header(folder_.file("store/index.sqlite")).format, kStoreFormat + 1);
}

TEST_F(Doctor, AStoreThatIsAFileIsNotCalledUnwritable) {
  std::ofstream(folder_.file("store")) << "no folder";
  const Json found = checks()["store"];
  EXPECT_NE(found["advice"].get<std::string>().find("Give a folder"), std::string::npos) << found;
}

TEST_F(Doctor, AStoreThatMayNotBeWrittenSaysSo) {
  // root may write everywhere; access() asks for the real user
  const bool root = ::geteuid() == 0;
  std::filesystem::permissions(folder_.path(), std::filesystem::perms(0755));
  std::filesystem::create_directory(folder_.file("store"));
  std::filesystem::permissions(folder_.file("store"), std::filesystem::perms(0555));
  if (root) {
    ASSERT_EQ(::setresuid(65534, 65534, 0), 0);
  }
  const Json found = checks()["store"];
  if (root) {
    ASSERT_EQ(::setresuid(0, 0, 0), 0);
  }
  EXPECT_NE(found["advice"].get<std::string>().find("may write"), std::string::npos) << found;
  std::filesystem::permissions(folder_.file("store"), std::filesystem::perms::owner_all);
}

TEST_F(Doctor, AHandleIsListenedTo) {
  Pty pty;
  const std::string port = pty.path();
  {
    SimulatedHandle handle(pty);
    auto found = checks({"--serial", port});
    EXPECT_NE(found["handle"]["detail"].get<std::string>().find("samples/s, 0 lost, 0 corrupt"), std::string::npos) << found["handle"];
  }
  auto silent = checks({"--serial", port});
  EXPECT_FALSE(silent["handle"]["ok"].get<bool>());
  EXPECT_NE(silent["handle"]["detail"].get<std::string>().find("says nothing"), std::string::npos) << silent["handle"];
}

TEST_F(Doctor, ACalibrationWithoutItsHandleIsRefused) {
  expect_refused({"doctor", "--forceps", folder_.file("forceps.yaml")}, {"--forceps", folder_.file("forceps.yaml"), "expected --serial PATH beside it"});
}

TEST_F(Doctor, TextMarksWhatIsWrong) {
  const Call c = call({"doctor", "--store", folder_.file("store"), "--viewer", folder_.file("none")});
  EXPECT_EQ(c.code, kFailed);
  EXPECT_NE(c.out.find("NOT   viewer"), std::string::npos) << c.out;
  EXPECT_NE(c.out.find("ok    files"), std::string::npos) << c.out;
}

}  // namespace doctor_test
}  // namespace filum
