#include "cli/trainer_lab.h"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <thread>

#include "short_session.h"
#include "tests/devices/simulated_handle.h"
#include "tests/session/synthetic.h"

namespace filum {
namespace trainer_lab_test {

using nlohmann::json;
using namespace std::chrono_literals;

class TrainerLabTest : public testing::Test {
 protected:
  LabOptions options() const { return {FILUM_SOURCE_DIR, folder_.file("datasets"), folder_.file("lab"), "", "", "", ""}; }
  TrainerLab lab(LabOptions o) {
    return TrainerLab(std::move(o), [this](const std::string& id) -> std::optional<std::string> {
      if (id != "one" && id != "broken") return std::nullopt;
      return folder_.file(id);
    });
  }
  static std::string refusal(TrainerLab& lab, const char* path, const std::string& body) {
    const auto answer = lab.post(path, body);
    return answer ? json::parse(*answer).value("refused", "") : "not found";
  }
  synthetic::Folder folder_;
};

TEST_F(TrainerLabTest, EveryPageHasAnAnswerBeforeAnythingWasAskedFor) {
  TrainerLab l = lab(options());
  EXPECT_TRUE(json::parse(*l.get("/api/reconcile")).at("datasets").empty());
  EXPECT_EQ(json::parse(*l.get("/api/calibration")).at("port"), "");
  EXPECT_EQ(json::parse(*l.get("/api/study")).at("state"), "idle");
  EXPECT_FALSE(json::parse(*l.get("/api/camera")).at("there").get<bool>());
  for (const char* path : {"/api/other", "/api/analysis/none", "/api/analysis/one/none"}) EXPECT_FALSE(l.get(path).has_value()) << path;
  for (const char* path : {"/documents/reconcile/none", "/documents/reconcile/none/report.html", "/documents/reconcile/../x", "/documents/analysis/one", "/documents/study/study.html", "/documents/camera/preview.jpg", "/documents/other"})
    EXPECT_FALSE(l.document(path).has_value()) << path;
}

TEST_F(TrainerLabTest, WhatCannotBeDoneIsRefusedInWords) {
  TrainerLab l = lab(options());
  EXPECT_NE(refusal(l, "/api/reconcile/start", R"({"dataset":"none"})").find("found none"), std::string::npos);
  EXPECT_NE(refusal(l, "/api/reconcile/start", "no json").find("dataset: found nothing"), std::string::npos);
  EXPECT_NE(refusal(l, "/api/study/start", R"({"sessions":["gone"],"clamped":[]})").find("found gone"), std::string::npos);
  EXPECT_NE(refusal(l, "/api/study/start", R"({"sessions":[7],"clamped":[]})").find("identifiers"), std::string::npos);
  EXPECT_NE(refusal(l, "/api/calibration/start", "{}").find("--serial"), std::string::npos);
  EXPECT_NE(refusal(l, "/api/calibration/read", "{}").find("that was started"), std::string::npos);
  EXPECT_NE(refusal(l, "/api/camera/undo", "{}").find("that was started"), std::string::npos);
  for (const char* path : {"/api/study/other", "/api/other", "/api/reconcile"}) EXPECT_EQ(refusal(l, path, "{}"), "not found") << path;
}

TEST_F(TrainerLabTest, ARecordingIsAnalysedInTheBackground) {
  {
    const auto recorder = make_recorder(folder_.file("one"), load_setup(FILUM_SOURCE_DIR, "tip-hold"), "demonstrator");
    started_session(recorder.get())->wait();
  }
  TrainerLab l = lab(options());
  const auto ended = [&](const std::string& id) {
    json d = json::parse(*l.get("/api/analysis/" + id));
    for (int k = 0; k < 4000 && d.at("state") == "working"; ++k) {
      std::this_thread::sleep_for(5ms);
      d = json::parse(*l.get("/api/analysis/" + id));
    }
    return d;
  };
  EXPECT_EQ(json::parse(*l.get("/api/analysis/one")).at("state"), "working");
  const json done = ended("one");
  ASSERT_EQ(done.at("state"), "ready") << done;
  EXPECT_NE(l.document(done.at("document").get<std::string>())->text.find("remor"), std::string::npos);
  const json failed = ended("broken");
  EXPECT_EQ(failed.at("state"), "failed");
  EXPECT_NE(failed.at("message").get<std::string>().find(folder_.file("broken")), std::string::npos);
  EXPECT_FALSE(l.document("/documents/analysis/broken").has_value());
}

TEST_F(TrainerLabTest, ACalibrationHasTheForcepsToItselfAndCanBeStopped) {
  Pty pty;
  SimulatedHandle handle(pty);
  LabOptions o = options();
  o.serial_port = pty.path();
  o.calibration = "as-chosen.yaml";
  TrainerLab l = lab(o);
  l.port_in_use(true);
  EXPECT_NE(refusal(l, "/api/calibration/start", "{}").find("end the task first"), std::string::npos);
  l.port_in_use(false);
  const json status = json::parse(*l.post("/api/calibration/start", "{}"));
  EXPECT_EQ(status.at("run").at("state"), "asking") << status;
  EXPECT_TRUE(l.calibrating());
  EXPECT_NE(refusal(l, "/api/calibration/use", "{}").find("that was accepted"), std::string::npos);
  EXPECT_EQ(l.calibration(), "as-chosen.yaml");
  EXPECT_TRUE(json::parse(*l.post("/api/calibration/stop", "{}")).at("run").is_null());
  EXPECT_FALSE(l.calibrating());
}

}  // namespace trainer_lab_test
}  // namespace filum
