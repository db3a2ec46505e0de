#pragma once
// Text from files must be UTF-8 before it goes into reports: other bytes would break JSON and show as rubbish. Test: utf8_test.

#include <string>
#include <string_view>

namespace filum {

/// Place of the first byte that does not belong to UTF-8 (RFC 3629: no overlong forms, no surrogates); npos where there is none.
std::size_t first_not_utf8(std::string_view text);

/// Throws InputError with "FILE:LINE", the byte and its place in the line, where `text` is not UTF-8 or holds a zero byte. `kind`: what was expected, "a CSV file".
void require_utf8(std::string_view text, const std::string& file, const std::string& kind);

/// `text` with every byte that is not UTF-8 turned to '?'.
std::string with_utf8_only(std::string text);

}  // namespace filum
