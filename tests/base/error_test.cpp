#include "base/error.h"

#include <gtest/gtest.h>

TEST(InputError, NamesFileFieldValueAndExpected) {
  const filum::InputError error("a.yaml:7", "diameter", "\"3 kg\"", "a length like 25 um");
  EXPECT_STREQ(error.what(), "a.yaml:7: diameter: found \"3 kg\", expected a length like 25 um");
  EXPECT_EQ(error.file, "a.yaml:7");
  EXPECT_EQ(error.field, "diameter");
  EXPECT_EQ(error.value, "\"3 kg\"");
  EXPECT_EQ(error.expected, "a length like 25 um");
}
