#pragma once
// Counts the memory a program takes from the system: stands before glibc's malloc, so that it sees operator new, Eigen and C
// libraries alike. Include in one source file of a test only. Not with sanitizers, which stand there themselves.

#include <cstddef>

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
inline thread_local long allocations = 0;  // by this thread
}

#if FILUM_COUNTS_ALLOCATIONS
extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);

void* malloc(std::size_t n) noexcept {
  ++filum::allocations;
  return __libc_malloc(n);
}
void* calloc(std::size_t n, std::size_t size) noexcept {
  ++filum::allocations;
  return __libc_calloc(n, size);
}
void* realloc(void* p, std::size_t n) noexcept {
  ++filum::allocations;
  return __libc_realloc(p, n);
}
void* aligned_alloc(std::size_t alignment, std::size_t n) noexcept {
  ++filum::allocations;
  return __libc_memalign(alignment, n);
}
}
#endif
