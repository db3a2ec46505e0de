// GET /api/sessions...: what the store holds, in the words of the schema.

#include <gtest/gtest.h>

#include <fstream>

#include "short_session.h"
#include "started_trainer.h"
#include "tests/server/schema_check.h"

namespace filum {
namespace trainer_api_test {

using nlohmann::json;

/// A store with one finished session of tip-hold and one recording that is damaged.
struct Filled {
  Filled() {
    Store store(folder.file("store"));
    const StoreEntry one = store.begin("tip-hold", "P01"), other = store.begin("knot-square", "");
    const auto recorder = make_recorder(store.file_of(one.id), load_setup(FILUM_SOURCE_DIR, "tip-hold"), "demonstrator", "P01");
    const auto session = started_session(recorder.get());
    const Result r = session->wait().result;
    store.finish(one.id, ScoreRecord{r.passed, r.total, r.seconds, ""});
    std::ofstream(store.file_of(other.id)) << "no recording";
    id = one.id, damaged = other.id, total = r.total;
    options.store_folder = folder.file("store");
  }
  synthetic::Folder folder;
  TrainerOptions options;
  std::string id, damaged;
  double total = 0.0;
};

TEST(TrainerApi, SessionsAreListedWithTaskInputCodeAndScore) {
  const Filled store;
  StartedTrainer trainer(store.options);
  const json d = json::parse(*trainer->api("/api/sessions"));
  EXPECT_EQ(SchemaCheck().fault(d, "SessionList"), "");
  ASSERT_EQ(d.at("sessions").size(), 2u);
  for (const json& s : d.at("sessions")) {
    const bool sound = s.at("id") == store.id;
    EXPECT_EQ(s.at("task"), sound ? "tip-hold" : "knot-square");
    EXPECT_EQ(s.at("input"), sound ? "demo" : "");
    EXPECT_EQ(s.at("exam"), false);
    EXPECT_EQ(s.at("stiffness"), 1.0);
    EXPECT_EQ(s.at("total"), sound ? json(store.total) : json(nullptr));
    EXPECT_NE(s.at("title"), s.at("task"));
  }
}

TEST(TrainerApi, OneSessionHasItsResultAndItsCurves) {
  const Filled store;
  StartedTrainer trainer(store.options);
  const json detail = json::parse(*trainer->api("/api/sessions/" + store.id)), series = json::parse(*trainer->api("/api/sessions/" + store.id + "/series"));
  EXPECT_EQ(SchemaCheck().fault(detail, "SessionDetail"), "");
  EXPECT_EQ(SchemaCheck().fault(series, "SeriesList"), "");
  EXPECT_EQ(detail.at("session").at("code"), "P01");
  EXPECT_EQ(detail.at("result").at("session"), store.id);
  EXPECT_FALSE(series.at("paths").empty());
}

TEST(TrainerApi, ADamagedRecordingIsListedWithoutAResultAndUnknownOnesAreNotFound) {
  const Filled store;
  StartedTrainer trainer(store.options);
  EXPECT_TRUE(json::parse(*trainer->api("/api/sessions/" + store.damaged)).at("result").is_null());
  EXPECT_TRUE(json::parse(*trainer->api("/api/sessions/" + store.damaged + "/series")).at("series").empty());
  for (const char* path : {"/api/sessions/none", "/api/sessions/../index", "/api/sessions/", "/api/nothing"}) EXPECT_FALSE(trainer->api(path).has_value()) << path;
}

}  // namespace trainer_api_test
}  // namespace filum
