#include "session/journal.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>
#include <vector>

namespace filum {
namespace {

constexpr std::size_t kHead = 32, kFrameHead = 24;  // [bytes]
constexpr std::uint32_t kMagic = 0x377f0682;        // its lowest bit: checksums are of big-endian words

std::uint32_t big_endian(const char* at) {
  std::uint32_t value = 0;
  for (int i = 0; i < 4; ++i) value = value << 8 | static_cast<unsigned char>(at[i]);
  return value;
}

std::uint32_t little_endian(const char* at) {
  std::uint32_t value = 0;
  for (int i = 3; i >= 0; --i) value = value << 8 | static_cast<unsigned char>(at[i]);
  return value;
}

/// Each frame's checksum goes on from that of the one before.
struct Checksum {
  bool big = false;
  std::uint32_t a = 0, b = 0;

  void add(const char* bytes, std::size_t n) {
    const auto word = [this](const char* at) { return big ? big_endian(at) : little_endian(at); };
    for (std::size_t i = 0; i + 8 <= n; i += 8) {
      a += word(bytes + i) + b;
      b += word(bytes + i + 4) + a;
    }
  }
  bool is(const char* stored) const { return a == big_endian(stored) && b == big_endian(stored + 4); }
};

}  // namespace

std::string journal_damage(const std::string& file) {
  std::ifstream log(file, std::ios::binary);
  std::array<char, kHead> head{};
  if (!log.read(head.data(), kHead)) return "";
  Checksum sum{(big_endian(head.data()) & 1U) != 0, 0, 0};
  sum.add(head.data(), kHead - 8);
  const std::size_t page = big_endian(head.data() + 8);
  if ((big_endian(head.data()) & ~1U) != kMagic || !sum.is(head.data() + kHead - 8) || page > 65536) return "journal with a wrong checksum at its head";
  std::vector<char> frame(kFrameHead + page);
  long first_bad = 0;
  for (long n = 1; log.read(frame.data(), static_cast<std::streamsize>(frame.size())); ++n) {
    const bool of_this_log = std::equal(frame.begin() + 8, frame.begin() + 16, head.begin() + 16);
    sum.add(frame.data(), 8);
    sum.add(frame.data() + kFrameHead, page);
    if (first_bad == 0 && !(of_this_log && sum.is(frame.data() + 16))) first_bad = n;
    const bool commits = big_endian(frame.data() + 4) != 0;
    if (first_bad != 0 && n > first_bad && of_this_log && commits) return "journal frame " + std::to_string(first_bad) + " with a wrong checksum, and what was recorded after it";
  }
  return "";
}

}  // namespace filum
