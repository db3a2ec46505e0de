#pragma once
// The guided calibration of the forceps behind the trainer's page: the same guide, fit and file as `filum calibrate forceps`; a thread
// reads the handle while a value is being taken. Test: tests/cli/calibration_session_test.cpp.

#include <atomic>
#include <memory>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <thread>
#include <vector>

#include "cli/calibration_plan.h"
#include "devices/calibration_file.h"
#include "devices/calibration_guide.h"

namespace filum {

class CalibrationSession {
 public:
  /// Opens the port; throws InputError.
  explicit CalibrationSession(CalibrationPlan plan);
  ~CalibrationSession();
  CalibrationSession(const CalibrationSession&) = delete;

  nlohmann::ordered_json status() const;
  /// The value asked for is set: read it. Ignored while reading or when all is done.
  void read();
  /// The last value again (or the reading under way); not once all is done.
  void undo();
  /// Path of the file once both fits are good, else empty.
  std::string file() const;

 private:
  struct Reader;
  void work();
  void finish();

  CalibrationPlan plan_;
  mutable std::mutex guard_;
  std::vector<CalibrationGuide> guides_;  // angle, force; guarded
  std::size_t at_ = 0;                    // which of them; guarded
  std::string trouble_, file_;            // guarded
  double live_[2] = {-1.0, -1.0};         // [count], newest of angle and force, below 0 none; guarded
  CalibrationFit angle_, force_;          // guarded
  std::atomic<bool> quit_ = false;
  std::unique_ptr<Reader> reader_;
  std::thread thread_;
};

}  // namespace filum
