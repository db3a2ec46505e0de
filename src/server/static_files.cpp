#include "server/static_files.h"

#include <algorithm>
#include <array>
#include <utility>

namespace filum {
namespace {

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

}  // namespace

std::optional<std::string> request_path(std::string_view target) {
  target = target.substr(0, target.find_first_of("?#"));
  if (target.empty() || target.front() != '/') return std::nullopt;
  std::string path;
  for (std::size_t i = 0; i < target.size(); ++i) {
    char c = target[i];
    if (c == '%') {
      const int high = i + 2 < target.size() ? hex_digit(target[i + 1]) : -1;
      const int low = i + 2 < target.size() ? hex_digit(target[i + 2]) : -1;
      if (high < 0 || low < 0) return std::nullopt;
      c = static_cast<char>(high * 16 + low);
      i += 2;
    }
    if (static_cast<unsigned char>(c) < 0x20 || c == '\\') return std::nullopt;
    path.push_back(c);
  }
  return path;
}

std::optional<std::filesystem::path> find_static_file(const std::filesystem::path& folder, std::string_view path) {
  namespace fs = std::filesystem;
  if (path.empty() || path.front() != '/') return std::nullopt;
  std::string relative(path.substr(1));
  if (relative.empty()) relative = "index.html";
  std::error_code error;
  const fs::path root = fs::canonical(folder, error);
  if (error) return std::nullopt;
  const fs::path wanted(relative);
  if (wanted.is_absolute()) return std::nullopt;
  const fs::path file = fs::canonical(root / wanted, error);
  if (error || !fs::is_regular_file(file, error)) return std::nullopt;
  // canonical() has resolved every ".." and link, so a common prefix of whole path elements is proof of being inside.
  const auto split = std::mismatch(root.begin(), root.end(), file.begin(), file.end());
  if (split.first != root.end()) return std::nullopt;
  return file;
}

std::string_view media_type(const std::filesystem::path& file) {
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 14> kTypes = {{
      {".html", "text/html; charset=utf-8"}, {".js", "text/javascript; charset=utf-8"},
      {".css", "text/css; charset=utf-8"},   {".json", "application/json"},
      {".svg", "image/svg+xml"},             {".png", "image/png"},
      {".jpg", "image/jpeg"},                {".webp", "image/webp"},
      {".ico", "image/x-icon"},              {".woff2", "font/woff2"},
      {".wasm", "application/wasm"},         {".txt", "text/plain; charset=utf-8"},
      {".hdr", "image/vnd.radiance"},        {".map", "application/json"},
  }};
  const std::string extension = file.extension().string();
  for (const auto& [name, type] : kTypes) {
    if (extension == name) return type;
  }
  return "application/octet-stream";
}

}  // namespace filum
