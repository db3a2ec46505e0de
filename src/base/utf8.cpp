#include "base/utf8.h"

#include <algorithm>
#include <cstdio>

#include "base/error.h"

namespace filum {
namespace {

/// Bytes of the character that starts at `text[at]`; 0 where none does.
std::size_t character(std::string_view text, std::size_t at) {
  const auto byte = [&](std::size_t k) { return at + k < text.size() ? static_cast<unsigned char>(text[at + k]) : 0u; };
  const unsigned first = byte(0);
  if (first < 0x80) return 1;
  const std::size_t length = first >= 0xC2 && first < 0xE0 ? 2 : first >= 0xE0 && first < 0xF0 ? 3 : first >= 0xF0 && first < 0xF5 ? 4 : 0;
  for (std::size_t k = 1; k < length; ++k)
    if ((byte(k) & 0xC0u) != 0x80u) return 0;
  const unsigned second = byte(1);
  const bool overlong = (first == 0xE0 && second < 0xA0) || (first == 0xF0 && second < 0x90);
  const bool outside = (first == 0xED && second > 0x9F) || (first == 0xF4 && second > 0x8F);
  return overlong || outside ? 0 : length;
}

}  // namespace

std::size_t first_not_utf8(std::string_view text) {
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = character(text, at);
    if (length == 0) return at;
    at += length;
  }
  return std::string_view::npos;
}

void require_utf8(std::string_view text, const std::string& file, const std::string& kind) {
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF")) throw InputError(file + ":1", "text", "UTF-16", kind + " in UTF-8 (save it as UTF-8)");
  const std::size_t bad = std::min(first_not_utf8(text), text.find('\0'));
  if (bad == std::string_view::npos) return;
  const std::string_view before = text.substr(0, bad);
  const std::size_t start = before.rfind('\n') == std::string_view::npos ? 0 : before.rfind('\n') + 1;
  char found[80];
  if (text[bad] == '\0') std::snprintf(found, sizeof found, "a zero byte");
  else std::snprintf(found, sizeof found, "the byte 0x%02X after %zu others of its line", static_cast<unsigned>(static_cast<unsigned char>(text[bad])), bad - start);
  throw InputError(file + ":" + std::to_string(1 + std::count(before.begin(), before.end(), '\n')), "text", found, kind + " in UTF-8 (save it as UTF-8)");
}

std::string with_utf8_only(std::string text) {
  for (std::size_t bad = first_not_utf8(text); bad != std::string::npos; bad = first_not_utf8(text)) text[bad] = '?';
  return text;
}

}  // namespace filum
