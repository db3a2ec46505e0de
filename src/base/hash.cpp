#include "base/hash.h"

#define XXH_INLINE_ALL  // tuned for the machine this is compiled for; results are the same everywhere
#include <xxhash.h>

namespace filum {

std::uint64_t hash_bytes(const void* data, std::size_t size, std::uint64_t seed) noexcept {
  static constexpr char kNothing = 0;  // XXH3 wants a valid pointer even for no bytes
  return XXH3_64bits_withSeed(size == 0 ? &kNothing : data, size, seed);
}

}  // namespace filum
