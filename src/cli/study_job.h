#pragma once
// The study of grasp force, accuracy and tremor behind the trainer's page: one at a time, in a thread of its own, with progress and a way
// to stop. A session that cannot be read is left out and said to be. Test: tests/cli/study_job_test.cpp.

#include <atomic>
#include <functional>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "analysis/study.h"
#include "server/server.h"

namespace filum {

class StudyJob {
 public:
  struct Choice {
    std::string id, file;
  };
  /// `load`: a recording's movements and forces; throws InputError.
  explicit StudyJob(std::function<RecordedSession(const std::string& file)> load) : load_(std::move(load)) {}
  /// Stops what runs.
  ~StudyJob();
  StudyJob(const StudyJob&) = delete;

  nlohmann::ordered_json status() const;
  /// `clamped`: recordings with the tool clamped, one for each device. Throws InputError where there is nothing to study or one runs.
  void start(std::vector<Choice> sessions, std::vector<Choice> clamped);
  void cancel() { cancelled_ = true; }
  /// study.html, study.json, sessions.csv, parts.csv, plot-TASK.svg of the study that is done.
  std::optional<Document> file(const std::string& name) const;

 private:
  struct LeftOut {
    std::string id, why;
  };
  struct State {
    std::string state = "idle";  // idle, running, done, cancelled, failed
    std::string message;
    std::size_t at = 0, of = 0;
    std::vector<LeftOut> left_out;
  };
  void work(const std::vector<Choice>& sessions, const std::vector<Choice>& clamped);
  void set(const State& state);

  const std::function<RecordedSession(const std::string& file)> load_;
  mutable std::mutex guard_;
  State now_;                  // guarded
  std::optional<Study> done_;  // guarded
  std::atomic<bool> cancelled_ = false;
  std::thread worker_;
};

}  // namespace filum
