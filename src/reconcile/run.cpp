#include "reconcile/run.h"

#include <atomic>
#include <exception>
#include <thread>
#include <vector>

namespace filum::reconcile {

void stop_if_cancelled(const Run& run) {
  if (run.cancelled && run.cancelled()) throw Cancelled();
}

void say(const Run& run, const char* stage, double share) {
  stop_if_cancelled(run);
  if (run.progress) run.progress(stage, share);
}

void parallel(int threads, std::size_t n, const std::function<void(std::size_t)>& work) {
  std::atomic<std::size_t> next = 0;
  std::atomic<bool> failed = false;
  std::exception_ptr failure;
  std::mutex guard;
  const auto loop = [&] {
    for (std::size_t i = next++; i < n && !failed; i = next++) {
      try {
        work(i);
      } catch (...) {
        const std::lock_guard lock(guard);
        failure = std::current_exception();
        failed = true;
      }
    }
  };
  std::vector<std::thread> pool;
  for (int i = 1; i < threads; ++i) pool.emplace_back(loop);
  loop();
  for (std::thread& t : pool) t.join();
  if (failure) std::rethrow_exception(failure);
}

void Steps::done() {
  const std::lock_guard lock(guard_);
  ++done_;
  if (run_.progress) run_.progress(stretch_.stage, stretch_.from + (stretch_.to - stretch_.from) * static_cast<double>(done_) / static_cast<double>(all_));
}

}  // namespace filum::reconcile
