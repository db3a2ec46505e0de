#include "reconcile/whole_file.h"

#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace filum::reconcile {

void write_whole(const std::string& path, const std::string& text) {
  const std::string beside = path + ".part";
  {
    std::ofstream file(beside, std::ios::binary);
    file << text;
    file.flush();
    if (!file) throw std::runtime_error(path + " cannot be written");
  }
  std::filesystem::rename(beside, path);
}

}  // namespace filum::reconcile
