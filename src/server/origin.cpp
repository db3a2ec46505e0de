#include <algorithm>
#include <string>

#include "server/server.h"

namespace filum {
namespace {

std::string lower(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return result;
}

std::string without_port(const std::string& host) {
  if (!host.empty() && host.front() == '[') return host.substr(0, host.find(']') + 1);
  return host.substr(0, host.find(':'));
}

/// 127.0.0.1 and its like, not 127.example.org.
bool is_loopback(const std::string& name) { return name.starts_with("127.") && name.find_first_not_of("0123456789.") == std::string::npos; }

}  // namespace

bool origin_allowed(std::string_view origin, std::string_view host, bool on_loopback) {
  const std::string name = without_port(lower(host));
  if (on_loopback && name != "localhost" && name != "[::1]" && !is_loopback(name)) return false;
  if (origin.empty()) return true;
  return lower(origin) == "http://" + lower(host) || lower(origin) == "https://" + lower(host);
}

}  // namespace filum
