#pragma once
// How a reconciliation runs: threads, progress, cancelling. Results do not depend on any of it.

#include <cstddef>
#include <functional>
#include <mutex>
#include <string>

namespace filum::reconcile {

struct Run {
  int threads = 2;
  std::function<void(const std::string& stage, double share)> progress;  // may be empty; by any thread, one at a time, share never falls
  std::function<bool()> cancelled;                                       // may be empty; asked before every fit, by any thread
};

/// Thrown by reconcile() when it was cancelled.
struct Cancelled {};
void stop_if_cancelled(const Run& run);
/// Tells where it is; throws Cancelled if it is to stop there.
void say(const Run& run, const char* stage, double share);

/// Runs work(0 ... n-1) on some threads; the order of results does not depend on how many.
void parallel(int threads, std::size_t n, const std::function<void(std::size_t)>& work);

/// A stretch of the progress bar.
struct Stretch {
  const char* stage;
  double from, to;
};

/// Tells how far a stretch has come after each of its fits, whichever thread made it.
class Steps {
 public:
  Steps(const Run& run, const Stretch& stretch, std::size_t all) : run_(run), stretch_(stretch), all_(all) {}
  void done();

 private:
  const Run& run_;
  const Stretch stretch_;
  const std::size_t all_;
  std::size_t done_ = 0;
  std::mutex guard_;
};

}  // namespace filum::reconcile
