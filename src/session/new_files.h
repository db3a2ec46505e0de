#pragma once
// Files of an export are whole or not there: they are written in a folder aside and put in their places when all of them are on disk.
// Private to session.

#include <filesystem>
#include <string>
#include <vector>

namespace filum {

/// The disk is full or fails: no fault of what was asked for, hence no InputError.
[[noreturn]] void throw_unwritten(const std::string& path);
/// Throws InputError where `path` is taken.
void require_unused(const std::filesystem::path& path);

/// A folder for new files, made with those above it where they are not there. What was made for it and is empty at the end, where nothing was put, is taken away.
class MadeFolder {
 public:
  /// Throws InputError, naming `asked_for`, where it cannot be made.
  MadeFolder(std::filesystem::path folder, const std::string& asked_for);
  ~MadeFolder();
  MadeFolder(const MadeFolder&) = delete;
  MadeFolder& operator=(const MadeFolder&) = delete;

  const std::filesystem::path& path() const noexcept { return folder_; }

 private:
  std::filesystem::path folder_;
  std::vector<std::filesystem::path> made_;  // innermost first
};

class NewFiles {
 public:
  /// For `names` in `folder`, which is made, and `shared`, which may be there already and is then replaced. Throws InputError where that cannot be, or where one of the
  /// others is there.
  NewFiles(const std::string& folder, std::vector<std::string> names, std::string shared);
  /// Leaves nothing that was not put in its place.
  ~NewFiles();
  NewFiles(const NewFiles&) = delete;
  NewFiles& operator=(const NewFiles&) = delete;

  /// Where a file is written until all are whole, and where it will be.
  std::string aside(const std::string& name) const { return (aside_ / name).string(); }
  std::string place(const std::string& name) const { return (folder_.path() / name).string(); }
  /// Puts all in their places, and says which these are.
  std::vector<std::string> put();

 private:
  MadeFolder folder_;
  std::filesystem::path aside_;
  std::vector<std::string> names_;
};

}  // namespace filum
