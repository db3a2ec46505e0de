#pragma once
// 64-bit XXH3 hashes of arrays: for state hashes and integrity checks, not for secrets. Bits are hashed as
// stored, so 0.0 and -0.0 differ and a hash is comparable only between runs of the same build.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <type_traits>

namespace filum {

/// Hash of `size` bytes; `seed` chains hashes: h = hash_bytes(b, nb, hash_bytes(a, na)).
std::uint64_t hash_bytes(const void* data, std::size_t size, std::uint64_t seed = 0) noexcept;

/// Hash of an array of plain numbers. Types with padding are refused.
template <class T, std::size_t N>
std::uint64_t hash_array(std::span<T, N> values, std::uint64_t seed = 0) noexcept {
  using Value = std::remove_cv_t<T>;
  static_assert(std::is_floating_point_v<Value> || std::has_unique_object_representations_v<Value>);
  return hash_bytes(values.data(), values.size_bytes(), seed);
}

inline std::uint64_t hash_text(std::string_view text, std::uint64_t seed = 0) noexcept {
  return hash_bytes(text.data(), text.size(), seed);
}

}  // namespace filum
