// Runs a fuzz target without libFuzzer: every seed of a folder as it is, cut short at many places, and with single bits flipped; files named
// one by one, which others look after, as they are.

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "base/rng.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

constexpr int kCuts = 64;
constexpr int kFlips = 256;

int run_seed(const std::vector<std::uint8_t>& seed, filum::Rng& rng) {
  LLVMFuzzerTestOneInput(seed.data(), seed.size());
  if (seed.empty()) return 1;
  for (int i = 0; i < kCuts; ++i) {
    const std::vector<std::uint8_t> cut(seed.begin(),
                                        seed.begin() + static_cast<std::ptrdiff_t>(rng.below(seed.size())));
    LLVMFuzzerTestOneInput(cut.data(), cut.size());
  }
  std::vector<std::uint8_t> changed = seed;
  for (int i = 0; i < kFlips; ++i) {
    if (i % 8 == 0) changed = seed;
    changed[rng.below(changed.size())] ^= static_cast<std::uint8_t>(1u << rng.below(8));
    LLVMFuzzerTestOneInput(changed.data(), changed.size());
  }
  return 1 + kCuts + kFlips;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: %s SEED_OR_FOLDER...\n", argv[0]);
    return 2;
  }
  namespace fs = std::filesystem;
  filum::Rng rng(7);
  int seeds = 0;
  int runs = 0;
  const auto run_file = [&](const fs::path& path, bool spoilt) {
    std::ifstream file(path, std::ios::binary);
    const std::vector<std::uint8_t> seed{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    if (spoilt) runs += run_seed(seed, rng);
    else LLVMFuzzerTestOneInput(seed.data(), seed.size()), ++runs;
    ++seeds;
  };
  for (int i = 1; i < argc; ++i) {
    if (fs::is_directory(argv[i])) {
      for (const auto& entry : fs::directory_iterator(argv[i])) run_file(entry.path(), true);
    } else if (fs::is_regular_file(argv[i])) {
      run_file(argv[i], false);
    }
  }
  std::printf("%d seeds, %d runs\n", seeds, runs);
  return seeds > 0 ? 0 : 1;
}
