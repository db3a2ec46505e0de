#pragma once
// The present time as text, in UTC. Test: utc_stamp_test.

#include <ctime>
#include <string>

namespace filum {

/// `format` as for strftime; the text must fit into 31 characters, else it is empty.
inline std::string utc_stamp(const char* format) {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  char text[32];
  return {text, std::strftime(text, sizeof text, format, &utc)};
}

}  // namespace filum
