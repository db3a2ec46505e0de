#pragma once
// Text within SVG and HTML. Test: markup_test.

#include <string>

namespace filum {

/// `text` with <, >, & and " written so that markup takes them for text.
std::string escaped(const std::string& text);

}  // namespace filum
