#include "base/utc_stamp.h"

#include <gtest/gtest.h>

#include <iomanip>
#include <sstream>

namespace filum {
namespace utc_stamp_test {

TEST(UtcStamp, IsThePresentTimeInUtc) {
  const std::time_t before = std::time(nullptr);
  std::tm read{};
  std::istringstream(utc_stamp("%Y-%m-%dT%H:%M:%SZ")) >> std::get_time(&read, "%Y-%m-%dT%H:%M:%SZ");
  const std::time_t stamped = timegm(&read);
  EXPECT_GE(stamped, before);
  EXPECT_LE(stamped, std::time(nullptr));
}

TEST(UtcStamp, IsEmptyWhereItDoesNotFit) { EXPECT_EQ(utc_stamp("%Y-%m-%d %Y-%m-%d %Y-%m-%d %Y-%m-%d"), ""); }

}  // namespace utc_stamp_test
}  // namespace filum
