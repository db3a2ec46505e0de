#pragma once
// Broken invariants of our own code stop the program at once with the place and the reason. Bad input is
// InputError instead.

#include <cstdio>
#include <cstdlib>

namespace filum::detail {

[[noreturn]] inline void ensure_failed(const char* condition, const char* message, const char* file,
                                       int line) noexcept {
  std::fprintf(stderr, "%s:%d: broken invariant: %s (%s)\n", file, line, condition, message);
  std::abort();
}

}  // namespace filum::detail

/// Checked in every build.
#define ENSURE(condition, message)    \
  ((condition) ? static_cast<void>(0) \
               : ::filum::detail::ensure_failed(#condition, message, __FILE__, __LINE__))

/// Checked in debug builds only: for conditions inside hot loops.
#ifdef NDEBUG
#define ASSERT(condition, message) static_cast<void>(sizeof(!(condition)))
#else
#define ASSERT(condition, message) ENSURE(condition, message)
#endif
