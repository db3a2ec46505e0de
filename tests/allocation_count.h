#pragma once
// Counts the memory a program takes from the system: stands before glibc's malloc, so that it sees operator new, Eigen and C
// libraries alike. Not with sanitizers, which stand there themselves.

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define FILUM_COUNTS_ALLOCATIONS 0
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(memory_sanitizer)
#define FILUM_COUNTS_ALLOCATIONS 0
#endif
#endif
#ifndef FILUM_COUNTS_ALLOCATIONS
#define FILUM_COUNTS_ALLOCATIONS 1
#endif

namespace filum {
extern thread_local long allocations;  // by this thread
}
