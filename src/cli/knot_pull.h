#pragma once
// The pull test of a session that has ended, in a thread of its own: it takes some twenty seconds, and the next task can begin meanwhile.

#include <atomic>
#include <exception>
#include <memory>
#include <string>
#include <thread>

#include "cli/live_session.h"

namespace filum {

class KnotPull {
 public:
  /// Takes over a session after its end(), and its recording if it has one.
  KnotPull(std::unique_ptr<LiveSession> session, std::unique_ptr<Recorder> recorder, std::string id);
  /// Abandons the test if it still runs; the score is then stored without it.
  ~KnotPull();

  const std::string& id() const noexcept { return id_; }
  double progress() const noexcept { return progress_.load(); }  // 0 to 1
  bool over() const noexcept { return over_.load(); }
  void abandon() noexcept { abandoned_.store(true); }

  /// Waits for the end of the test. The score is stored in the recording by then.
  Result finish();
  /// After finish(); null without a recording.
  const Recorder* recorder() const noexcept { return recorder_.get(); }

 private:
  std::string id_;
  std::unique_ptr<Recorder> recorder_;
  std::unique_ptr<LiveSession> session_;
  std::atomic<double> progress_{0.0};
  std::atomic<bool> abandoned_{false}, over_{false};
  Result result_;
  std::exception_ptr failure_;
  std::thread thread_;
};

}  // namespace filum
