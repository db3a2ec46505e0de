#pragma once
// What timings are made of.

#include <chrono>
#include <ctime>

namespace filum {

using Clock = std::chrono::steady_clock;

inline double milliseconds_since(Clock::time_point begin) { return std::chrono::duration<double, std::milli>(Clock::now() - begin).count(); }

/// [ms] of this thread on a processor: what others on the machine take is not in it.
inline double processor_ms() {
  std::timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}

}  // namespace filum
