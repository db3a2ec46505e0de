#include "cli/options.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <nlohmann/json.hpp>

namespace filum {

void add_root(CLI::App& command, CommonOptions& options) {
  options.root = source_folder();
  command.add_option("--root", options.root, "Folder that holds models/ and curricula/")->capture_default_str();
}

void add_common(CLI::App& command, CommonOptions& options) {
  add_root(command, options);
  command.add_flag("--json", options.json, "Print one JSON document and nothing else");
}

void print_json(std::FILE* out, const nlohmann::ordered_json& document) {
  const std::string text = json_text(document);
  std::fwrite(text.data(), 1, text.size(), out);
  std::fputc('\n', out);
  std::fflush(out);
}

const char* version() { return FILUM_VERSION; }

std::string program_text() { return std::string("filum ") + FILUM_VERSION + " (" + FILUM_BUILD + ")"; }

const char* source_folder() { return FILUM_ROOT; }

}  // namespace filum
