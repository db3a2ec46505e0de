// Sums have one order on every processor: Eigen takes the sizes by which it cuts products into blocks from its options (CMakeLists.txt), not from the machine.

#include <gtest/gtest.h>

#include <Eigen/Core>

namespace filum {
namespace same_sums_test {

TEST(SameSums, ProductsAreCutIntoBlocksByTheSameCachesOnEveryMachine) {
  EXPECT_EQ(Eigen::l1CacheSize(), 32 * 1024);
  EXPECT_EQ(Eigen::l2CacheSize(), 512 * 1024);
  EXPECT_EQ(Eigen::l3CacheSize(), 4 * 1024 * 1024);
}

}  // namespace same_sums_test
}  // namespace filum
