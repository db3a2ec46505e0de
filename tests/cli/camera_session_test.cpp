#include "cli/camera_session.h"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "cli/trainer_lab.h"

namespace filum {
namespace camera_session_test {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using Json = nlohmann::json;

/// A guide that says what it was told; `body` in shell.
class CameraSessionTest : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "filum-camera-XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  void TearDown() override { fs::remove_all(folder_); }
  CameraPlan plan(const std::string& body) const {
    const std::string program = folder_ + "/guide.sh";
    std::ofstream(program) << "#!/bin/sh\n" << body;
    fs::permissions(program, fs::perms::owner_all);
    CameraPlan p;
    p.program = program;
    p.folder = folder_;
    return p;
  }
  static Json until(const CameraSession& session, const std::string& state) {
    for (int k = 0; k < 4000; ++k) {
      const Json now = Json::parse(session.status().dump());
      if (now["state"] == state) return now;
      std::this_thread::sleep_for(5ms);
    }
    return Json::parse(session.status().dump());
  }
  std::string folder_;
};

TEST_F(CameraSessionTest, PassesCommandsOnAndShowsTheNewestState) {
  CameraSession session(plan(R"(echo '{"state":"looking","views":0}'
while read -r line; do echo "{\"state\":\"$line\",\"views\":1}"; done)"));
  EXPECT_EQ(until(session, "looking")["views"], 0);
  session.tell("undo");
  EXPECT_EQ(until(session, "undo")["state"], "undo");
  session.tell("calibrate");
  const Json done = until(session, "calibrate");
  EXPECT_EQ(done["views"], 1);
  EXPECT_EQ(done["source"], "0");
}

TEST_F(CameraSessionTest, AProgramThatEndsIsToldWithItsWords) {
  CameraSession session(plan("echo 'filum_camera: --source: found 0, expected a camera' >&2; exit 2\n"));
  const Json now = until(session, "failed");
  EXPECT_EQ(now["state"], "failed");
  EXPECT_NE(now["trouble"].get<std::string>().find("expected a camera"), std::string::npos);
}

TEST_F(CameraSessionTest, NonsenseAndEndlessLinesAreSurvived) {
  CameraSession nonsense(plan("echo '{\"state\": '; echo '[1]'; cat >/dev/null\n"));
  std::this_thread::sleep_for(100ms);
  EXPECT_EQ(nonsense.status()["state"], "starting");
  CameraSession endless(plan("head -c 1000000 /dev/zero | tr '\\0' x; cat >/dev/null\n"));
  EXPECT_EQ(until(endless, "failed")["state"], "failed");
}

TEST_F(CameraSessionTest, AProgramThatDoesNotQuitIsEnded) {
  const auto begin = std::chrono::steady_clock::now();
  { CameraSession session(plan("trap '' TERM HUP\nexec sleep 600\n")); }
  EXPECT_LT(std::chrono::steady_clock::now() - begin, 60s);
  EXPECT_THROW(CameraSession({folder_ + "/none", "0", folder_, "c", 10.0}), InputError);
}

TEST_F(CameraSessionTest, ThePictureIsTheOneOfThisCalibration) {
  std::ofstream(folder_ + "/preview.jpg") << "old";
  CameraSession session(plan("sleep 0.3; printf new >\"$5/next\"; mv \"$5/next\" \"$5/preview.jpg\"; echo '{\"state\":\"looking\"}'; cat >/dev/null\n"));
  until(session, "looking");
  EXPECT_EQ(session.preview(), "new");
}

TEST_F(CameraSessionTest, ThePageAsksThroughTheLaboratory) {
  LabOptions options;
  options.root = FILUM_SOURCE_DIR;
  options.folder = folder_;
  options.camera_program = plan(R"(echo '{"state":"looking","views":0}'
while read -r line; do echo "{\"state\":\"$line\"}"; done)").program;
  TrainerLab lab(options, [](const std::string&) { return std::nullopt; });
  const auto ask = [&] { return Json::parse(lab.get("/api/camera").value()); };
  EXPECT_TRUE(ask()["there"]);
  EXPECT_TRUE(ask()["run"].is_null());
  EXPECT_TRUE(Json::parse(lab.post("/api/camera/undo", "{}").value()).contains("refused")) << "nothing was started";
  EXPECT_FALSE(lab.document("/documents/camera/preview.jpg"));
  EXPECT_EQ(Json::parse(lab.post("/api/camera/start", R"({"source":1})").value())["run"]["source"], "1");
  lab.post("/api/camera/calibrate", "{}");
  for (int k = 0; k < 4000 && ask()["run"]["state"] != "calibrate"; ++k) std::this_thread::sleep_for(5ms);
  EXPECT_EQ(ask()["run"]["state"], "calibrate");
  EXPECT_TRUE(Json::parse(lab.post("/api/camera/stop", "{}").value())["run"].is_null());
  EXPECT_FALSE(lab.post("/api/camera/nothing", "{}").has_value() && !Json::parse(lab.post("/api/camera/nothing", "{}").value()).contains("refused"));
}

}  // namespace camera_session_test
}  // namespace filum
