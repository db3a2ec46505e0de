// filum mesh: hands over to the program that meshes head scans, which is built where CGAL and libnifti are installed.

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>

#include "base/file_kind.h"
#include "cli/options.h"

namespace filum {

void add_mesh(CLI::App& app, Action& action) {
  auto words = std::make_shared<std::vector<std::string>>();
  CLI::App* command = app.add_subcommand("mesh", "Make a brain region from a head scan (NIfTI)");
  command->prefix_command();
  command->set_help_flag();  // the other program's
  command->callback([command, words, &action] {
    *words = command->remaining();
    action.run = [words](const Streams& io) {
      const std::string program = std::filesystem::read_symlink("/proc/self/exe").parent_path() / "filum_mesh";
      if (!is_there(program)) {
        std::fprintf(io.err, "filum: mesh is not built: install libcgal-dev and libnifti-dev, then run ./filum test\n");
        return static_cast<int>(kFailed);
      }
      std::vector<char*> arguments = {const_cast<char*>(program.c_str())};
      for (std::string& word : *words) arguments.push_back(word.data());
      arguments.push_back(nullptr);
      execv(program.c_str(), arguments.data());
      std::fprintf(io.err, "filum: mesh: %s\n", std::strerror(errno));
      return static_cast<int>(kFailed);
    };
  });
}

}  // namespace filum
