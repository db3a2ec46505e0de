#pragma once
// What all subcommands share: where the data is, how results are printed, exit codes. Each subcommand is one file that adds
// itself to the command line; its callback returns the exit code.

#include <cstdio>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "cli/requests.h"

namespace CLI {
class App;
}

namespace filum {

enum ExitCode { kDone = 0, kFailed = 1, kBadInput = 2 };

struct CommonOptions {
  std::string root;   // folder with models/ and curricula/
  bool json = false;  // one JSON document on stdout, nothing else
};

/// Where a command reads and writes: those of the process, or those that a test looks into.
struct Streams {
  std::FILE* in = stdin;
  std::FILE* out = stdout;
  std::FILE* err = stderr;
};

/// Set by the subcommand that was asked for; run by program().
struct Action {
  std::function<int(const Streams&)> run;
};

void add_train(CLI::App& app, Action& action);
void add_run(CLI::App& app, Action& action);
void add_replay(CLI::App& app, Action& action);
void add_score(CLI::App& app, Action& action);
void add_export(CLI::App& app, Action& action);
void add_list(CLI::App& app, Action& action);
void add_validate(CLI::App& app, Action& action);
void add_bench(CLI::App& app, Action& action);
void add_analyse(CLI::App& app, Action& action);
void add_calibrate(CLI::App& app, Action& action);
void add_doctor(CLI::App& app, Action& action);
void add_reconcile(CLI::App& app, Action& action);
void add_import(CLI::App& app, Action& action);
void add_mesh(CLI::App& app, Action& action);

/// --root and --json.
void add_common(CLI::App& command, CommonOptions& options);
void add_root(CLI::App& command, CommonOptions& options);

void print_json(std::FILE* out, const nlohmann::ordered_json& document);

const char* version();
/// Program, version and build, as stored in recordings: equal replay is promised within one build.
std::string program_text();
/// Folder of the sources that the program was built from.
const char* source_folder();

}  // namespace filum
