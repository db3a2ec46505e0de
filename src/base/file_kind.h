#pragma once
// What lies at a path that somebody wrote: a name that the system refuses, too long for one, is a file that is not there, not an exception.
// Test: file_kind_test.

#include <filesystem>

namespace filum {

inline bool is_file(const std::filesystem::path& path) {
  std::error_code refused;
  return std::filesystem::is_regular_file(path, refused);
}
inline bool is_folder(const std::filesystem::path& path) {
  std::error_code refused;
  return std::filesystem::is_directory(path, refused);
}
inline bool is_there(const std::filesystem::path& path) {
  std::error_code refused;
  return std::filesystem::exists(path, refused);
}

}  // namespace filum
