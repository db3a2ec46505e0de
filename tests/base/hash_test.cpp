#include "base/hash.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

namespace filum {
namespace hash_test {

TEST(Hash, IsXxh3) {
  EXPECT_EQ(hash_text(""), 0x2D06800538D394C2ull);  // published test vector of XXH3_64bits, seed 0, no bytes
}

TEST(Hash, EveryBitCounts) {
  std::vector<double> values(200, 0.25);
  const std::uint64_t before = hash_array(std::span(values));
  for (std::size_t i = 0; i < values.size(); ++i) {
    auto changed = values;
    changed[i] = std::nextafter(changed[i], 1.0);
    EXPECT_NE(hash_array(std::span(changed)), before) << i;
  }
  EXPECT_EQ(hash_array(std::span(values)), before);
}

TEST(Hash, ChainsBySeed) {
  const std::array<int, 2> a{1, 2};
  const std::array<int, 2> b{3, 4};
  EXPECT_NE(hash_array(std::span(b), hash_array(std::span(a))),
            hash_array(std::span(a), hash_array(std::span(b))));
}

TEST(Hash, TellsMinusZeroFromZero) {
  const std::array<double, 1> zero{0.0};
  const std::array<double, 1> minus{-0.0};
  EXPECT_NE(hash_array(std::span(zero)), hash_array(std::span(minus)));
}

}  // namespace hash_test
}  // namespace filum
