#include "base/out_folder.h"

#include <fcntl.h>
#include <unistd.h>

#include <filesystem>

#include "base/error.h"
#include "base/file_kind.h"

namespace filum {
namespace fs = std::filesystem;

void require_out_folder(const std::string& option, const std::string& folder) {
  const auto refuse = [&](const std::string& why) { throw InputError(option, "folder", folder + " (" + why + ")", "a folder that can be written, or can be made"); };
  std::error_code error;
  fs::path at = fs::absolute(folder, error);
  if (error) refuse(error.message());
  while (fs::status(at, error).type() == fs::file_type::not_found && at != at.parent_path()) at = at.parent_path();
  if (!is_folder(at)) refuse(error ? error.message() : at.string() + " is a file");
  if (::faccessat(AT_FDCWD, at.c_str(), W_OK | X_OK, AT_EACCESS) != 0) refuse(at.string() + " cannot be written");
}

}  // namespace filum
