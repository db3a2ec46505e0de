#include "cli/program.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <exception>
#include <sstream>

#include "base/error.h"

namespace filum {
namespace {

void add_all(CLI::App& app, Action& action) {
  app.name("filum");
  app.require_subcommand(1);
  app.set_version_flag("--version", program_text());
  for (const auto add : {add_train, add_run, add_replay, add_score, add_export, add_list, add_validate, add_bench, add_analyse, add_calibrate, add_doctor, add_reconcile, add_import, add_mesh})
    add(app, action);
}

bool known(const CLI::App& app, const std::string& word) {
  const auto subcommands = app.get_subcommands([](const CLI::App*) { return true; });
  return std::any_of(subcommands.begin(), subcommands.end(), [&](const CLI::App* sub) { return sub->get_name() == word; });
}

/// An empty value, as of a script's variable that was not set, would be taken for an option that was not given.
void require_values(const CLI::App& app) {
  for (const CLI::Option* option : app.get_options([](const CLI::Option*) { return true; }))
    for (const std::string& text : option->results())
      if (text.empty()) throw InputError(option->get_name(), "value", "nothing", "a value, or no " + option->get_name());
  for (const CLI::App* chosen : app.get_subcommands()) require_values(*chosen);
}

/// "filum calibrate forceps", as far as it was understood.
std::string command_line_of(const CLI::App& app) {
  std::string words = app.get_name();
  for (const CLI::App* chosen : app.get_subcommands()) words += " " + command_line_of(*chosen);
  return words;
}

/// Help on io.out, faults on io.err.
int explain(const CLI::App& app, const CLI::ParseError& error, const Streams& io) {
  std::ostringstream out, err;
  const int code = app.exit(error, out, err);
  std::fputs(out.str().c_str(), io.out);
  if (code == 0) return kDone;
  std::fprintf(io.err, "filum: %s (`%s --help` tells what is expected)\n", error.what(), command_line_of(app).c_str());
  return kBadInput;
}

}  // namespace

int program(int argc, const char* const* argv, const Streams& io) {
  CLI::App app{"Filum: a microsurgery skills trainer"};
  Action action;
  add_all(app, action);
  if (argc > 1 && argv[1][0] != '-' && !known(app, argv[1])) {
    std::fprintf(io.err, "filum: subcommand: found %s, expected one of those that `filum --help` lists\n", argv[1]);
    return kBadInput;
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return explain(app, error, io);
  }
  try {
    require_values(app);
    const int code = action.run(io);
    if (std::fflush(io.out) == 0 && std::ferror(io.out) == 0) return code;
    std::fprintf(io.err, "filum: output: found an error (a full disk, a closed pipe), expected that all of it can be written\n");
    return code == kDone ? kFailed : code;
  } catch (const InputError& error) {
    std::fprintf(io.err, "filum: %s\n", error.what());
    return kBadInput;
  } catch (const std::exception& error) {
    std::fprintf(io.err, "filum: %s\n", error.what());
    return kFailed;
  }
}

}  // namespace filum
