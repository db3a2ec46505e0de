#include <gtest/gtest.h>

#include "server/server.h"

namespace filum {
namespace origin_test {

TEST(Origin, SameHostAndPortOnly) {
  EXPECT_TRUE(origin_allowed("http://127.0.0.1:8137", "127.0.0.1:8137", true));
  EXPECT_FALSE(origin_allowed("http://127.example.org:8137", "127.example.org:8137", true)) << "a name that its owner lets point here";
  EXPECT_FALSE(origin_allowed("", "127.0.0.1.example.org:8137", true));
  EXPECT_TRUE(origin_allowed("http://LOCALHOST:8137", "localhost:8137", true));
  EXPECT_TRUE(origin_allowed("http://[::1]:8137", "[::1]:8137", true));
  EXPECT_TRUE(origin_allowed("", "127.0.0.1:8137", true));
  EXPECT_FALSE(origin_allowed("http://127.0.0.1:9999", "127.0.0.1:8137", true));
  EXPECT_FALSE(origin_allowed("http://evil.example", "127.0.0.1:8137", true));
  EXPECT_FALSE(origin_allowed("null", "127.0.0.1:8137", true));
}

TEST(Origin, ForeignNamePointedAtThisMachineIsRefused) {
  EXPECT_FALSE(origin_allowed("http://evil.example:8137", "evil.example:8137", true));
  EXPECT_FALSE(origin_allowed("", "evil.example:8137", true));
  EXPECT_TRUE(origin_allowed("http://classroom-1:8137", "classroom-1:8137", false));
}

}  // namespace origin_test
}  // namespace filum
