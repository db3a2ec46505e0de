#include "base/utf8.h"

#include <gtest/gtest.h>

#include "base/error.h"

namespace filum {
namespace utf8_test {

std::string refusal(const std::string& text) {
  try {
    require_utf8(text, "a.csv", "a CSV file");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Utf8, TakesEveryLengthOfCharacter) {
  for (const char* text : {"", "plain", "\xC2\xB5m", "\xE2\x82\xAC", "\xF0\x9F\xA7\xB5", "\xED\x9F\xBF", "\xF4\x8F\xBF\xBF"}) EXPECT_EQ(refusal(text), "") << text;
}

/// Latin-1, cut off, overlong, surrogate, beyond U+10FFFF, a byte that never occurs.
TEST(Utf8, RefusesWhatIsNone) {
  for (const char* text : {"\xB5m", "\xC2", "\xC0\x80", "\xE0\x80\x80", "\xED\xA0\x80", "\xF4\x90\x80\x80", "\xFF", "\xE2\x82"}) EXPECT_NE(first_not_utf8(text), std::string_view::npos);
  EXPECT_EQ(first_not_utf8("ab\xB5"), 2u);
}

TEST(Utf8, SaysWhere) {
  EXPECT_EQ(refusal("t,u\n0,1\n0,f\xF6rce\n"), "a.csv:3: text: found the byte 0xF6 after 3 others of its line, expected a CSV file in UTF-8 (save it as UTF-8)");
  EXPECT_EQ(refusal(std::string("\xFF\xFEt\0", 4)), "a.csv:1: text: found UTF-16, expected a CSV file in UTF-8 (save it as UTF-8)");
  EXPECT_EQ(refusal(std::string("a\nb\0", 4)), "a.csv:2: text: found a zero byte, expected a CSV file in UTF-8 (save it as UTF-8)");
}

TEST(Utf8, ReplacesTheRest) { EXPECT_EQ(with_utf8_only("\xB5\xC2\xB5"), "?\xC2\xB5"); }

}  // namespace utf8_test
}  // namespace filum
