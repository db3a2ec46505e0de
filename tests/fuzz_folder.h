#pragma once
// What fuzz targets share: a folder for files whose readers want a path, and readers that may refuse.

#include <stdlib.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "base/error.h"

namespace filum::fuzz {

/// A folder of its own ($TMPDIR says where), gone with the program.
class Folder {
 public:
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "filum-fuzz-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) std::abort();
    path_ = name;
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  const std::string& path() const { return path_; }
  std::string file(const std::string& name) const { return path_ + "/" + name; }
  /// The file's path.
  std::string write(const std::string& name, std::string_view bytes) const {
    std::ofstream(file(name), std::ios::binary | std::ios::trunc).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    return file(name);
  }

 private:
  std::string path_;
};

inline std::string_view text_of(const std::uint8_t* data, std::size_t size) { return {reinterpret_cast<const char*>(data), size}; }

/// Reads; being refused is an answer, any other exception ends the program.
template <class Reader>
void read(Reader reader) {
  try {
    reader();
  } catch (const InputError&) {
  }
}

/// The word behind the first "format:", by which files of one layer are told apart.
inline std::string_view format_of(std::string_view text) {
  constexpr std::string_view kKey = "format: ";
  const std::size_t at = text.find(kKey);
  if (at == std::string_view::npos) return {};
  text.remove_prefix(at + kKey.size());
  return text.substr(0, text.find_first_of("\r\n"));
}

}  // namespace filum::fuzz
