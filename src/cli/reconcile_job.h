#pragma once
// Reconcile behind the trainer's page: one dataset at a time, in a thread of its own, with progress and a way to stop. Datasets are
// the folders of one folder that the user named; nothing outside it can be asked for. Test: tests/cli/reconcile_job_test.cpp.

#include <atomic>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <thread>

namespace filum {

class ReconcileJob {
 public:
  /// `datasets`: folder whose folders hold an experiment.yaml each; `reports`: where results go, one folder each; `root`: of models/.
  ReconcileJob(std::string datasets, std::string reports, std::string root) : datasets_(std::move(datasets)), reports_(std::move(reports)), root_(std::move(root)) {}
  /// Stops what runs.
  ~ReconcileJob();
  ReconcileJob(const ReconcileJob&) = delete;

  /// Datasets, reports there are and what runs now.
  nlohmann::ordered_json status();
  /// Throws InputError for an unknown dataset or while another one runs.
  void start(const std::string& dataset);
  void cancel() { cancelled_ = true; }
  /// report.html or model.yaml of a dataset.
  std::optional<std::string> file(const std::string& dataset, const std::string& name) const;

 private:
  struct State {
    std::string state = "idle";  // idle, running, done, cancelled, failed
    std::string dataset, stage, message;
    double share = 0.0;
  };
  void solve(std::string dataset);
  void set(const State& state);

  const std::string datasets_, reports_, root_;
  std::mutex guard_;
  State now_;                         // guarded
  std::atomic<bool> cancelled_ = false;
  std::thread worker_;
};

}  // namespace filum
