#include "session/new_files.h"

#include <unistd.h>

#include <cerrno>
#include <stdexcept>

#include "base/error.h"
#include "base/file_kind.h"

namespace filum {
namespace fs = std::filesystem;

void throw_unwritten(const std::string& path) { throw std::runtime_error(path + ": export: found a write error, expected a disk with space left"); }

void require_unused(const fs::path& path) {
  if (is_there(path)) throw InputError(path.string(), "export", "a file that exists", "a folder without it: an export is never written over");
}

MadeFolder::MadeFolder(fs::path folder, const std::string& asked_for) : folder_(std::move(folder)) {
  for (fs::path made = folder_; !made.empty() && !is_there(made); made = made.parent_path()) made_.push_back(made);
  std::error_code error;
  fs::create_directories(folder_, error);
  if (!is_folder(folder_)) throw InputError(asked_for, "export", error.message(), "a folder that can be made");
}

MadeFolder::~MadeFolder() {
  std::error_code ignored;
  for (const fs::path& made : made_) fs::remove(made, ignored);
}

NewFiles::NewFiles(const std::string& folder, std::vector<std::string> names, std::string shared) : folder_(folder, folder), names_(std::move(names)) {
  for (const std::string& name : names_) require_unused(place(name));
  names_.push_back(std::move(shared));
  std::string aside = (folder_.path() / ".export-XXXXXX").string();
  if (::mkdtemp(aside.data()) == nullptr) {
    if (errno == ENOSPC) throw_unwritten(folder);
    throw InputError(folder, "export", "a write error", "a folder that can be written");
  }
  aside_ = aside;
}

NewFiles::~NewFiles() {
  std::error_code ignored;
  fs::remove_all(aside_, ignored);
}

std::vector<std::string> NewFiles::put() {
  std::vector<std::string> places;
  for (const std::string& name : names_) {
    places.push_back(place(name));
    fs::rename(aside_ / name, places.back());
  }
  return places;
}

}  // namespace filum
