#pragma once
// The guided calibration of a camera behind the trainer's page. The guide itself is `filum_camera guide` (src/tracker), a program of its own,
// since the trainer does without OpenCV; here it is started, asked and ended. Test: tests/cli/camera_session_test.cpp.

#include <atomic>
#include <memory>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "cli/camera_plan.h"
#include "cli/child_process.h"

namespace filum {

class CameraSession {
 public:
  /// Starts the guide; throws InputError.
  explicit CameraSession(CameraPlan plan);
  ~CameraSession();
  CameraSession(const CameraSession&) = delete;

  /// The guide's newest state; "state" is "starting" before the first and "failed" with its words when it has ended.
  nlohmann::ordered_json status() const;
  /// "undo" or "calibrate".
  void tell(const std::string& command);
  /// The newest picture with what the guide has drawn into it, as JPEG.
  std::optional<std::string> preview() const;

 private:
  void work();

  const CameraPlan plan_;
  mutable std::mutex guard_;
  std::string said_, failed_;          // guarded: newest line, why it ended
  std::vector<std::string> commands_;  // guarded
  std::atomic<bool> quit_ = false;
  ChildProcess child_;
  std::thread thread_;
};

/// Path of filum_camera beside this program; empty where it was not built.
std::string camera_program();

}  // namespace filum
