#pragma once
// The laboratory behind the trainer's page: reconcile, guided calibration of the forceps and of a camera, analysis of
// recordings one by one and of many together. Called by the server's
// thread; whatever takes longer than a blink runs in a thread of its own and is asked for again. Test: tests/cli/trainer_lab_test.cpp.

#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <thread>

#include "cli/calibration_session.h"
#include "cli/camera_session.h"
#include "cli/dataset_upload.h"
#include "cli/reconcile_job.h"
#include "cli/study_job.h"
#include "server/server.h"

namespace filum {

struct LabOptions {
  std::string root;
  std::string datasets;      // folder of folders with an experiment.yaml
  std::string folder;        // for reports and calibrations
  std::string serial_port;   // of the forceps, empty: none
  std::string calibration;   // in use, empty: as built
  std::string camera;        // a video instead of a camera, empty: the page names a camera's number
  std::string camera_program;  // path of filum_camera, empty: not built
};

class TrainerLab {
 public:
  /// `recording_of`: file of a stored session, or nothing.
  TrainerLab(LabOptions options, std::function<std::optional<std::string>(const std::string&)> recording_of);
  ~TrainerLab();

  std::optional<std::string> get(std::string_view path);
  std::optional<std::string> post(std::string_view path, const std::string& body);
  std::optional<std::string> put(std::string_view path, const std::string& body);
  std::optional<Document> document(std::string_view path);

  /// Calibration that forceps sessions are to use.
  std::string calibration() const;
  bool calibrating() const;
  /// A session has the serial port.
  void port_in_use(bool used) { port_in_use_ = used; }

 private:
  struct Analysis {
    std::string state = "working", text;  // the page, or why there is none
  };
  nlohmann::ordered_json calibration_status() const;
  nlohmann::ordered_json camera_status() const;
  nlohmann::ordered_json change_camera(std::string_view what, const std::string& body);
  nlohmann::ordered_json change_study(std::string_view what, const std::string& body);
  nlohmann::ordered_json change(std::string_view path, const std::string& body);
  nlohmann::ordered_json change_upload(std::string_view what, const std::string& body);
  std::optional<std::string> analysis(const std::string& session, const std::string& clamped);
  void analyse_in_background(const std::string& key, const std::string& file, const std::string& clamped);

  const LabOptions options_;
  const std::function<std::optional<std::string>(const std::string&)> recording_of_;
  DatasetUpload upload_;  // of the server's thread
  ReconcileJob reconcile_;
  StudyJob study_;
  mutable std::mutex guard_;
  std::unique_ptr<CalibrationSession> calibration_;  // guarded
  std::string chosen_;                               // guarded
  std::unique_ptr<CameraSession> camera_;            // guarded
  std::map<std::string, Analysis> analyses_;         // guarded, by "session" or "session/clamped"
  bool analysing_ = false;                           // guarded
  std::thread analyst_;
  std::atomic<bool> port_in_use_ = false;
};

}  // namespace filum
