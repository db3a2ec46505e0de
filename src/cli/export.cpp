// filum export FILE: a recording as tables for other programs.

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/options.h"
#include "cli/session_files.h"
#include "session/export.h"

namespace filum {
namespace {

struct ExportOptions {
  std::string file, format = "csv", folder;
  bool json = false;
};

int print_files(const std::vector<std::string>& files, bool json, const Streams& io) {
  if (json) {
    print_json(io.out, {{"files", files}});
  } else {
    for (const std::string& file : files) std::fprintf(io.out, "%s\n", file.c_str());
  }
  return kDone;
}

int run(const ExportOptions& o, const Streams& io) {
  const RecordingReader recording(o.file);
  if (o.format == "bids") return print_files(export_bids(recording, o.folder), o.json, io);
  std::vector<Table> tables = recorded_tables(recording);
  {
    const RecordedSetup recorded(recording);
    World world(recorded.setup().model);
    tables.push_back(simulated_table(recording, world));
  }
  const auto files = o.format == "csv" ? export_csv(tables, recording.meta(), o.folder)
                                       : export_hdf5(tables, recording.meta(), o.folder);
  return print_files(files, o.json, io);
}

}  // namespace

void add_export(CLI::App& app, Action& action) {
  auto o = std::make_shared<ExportOptions>();
  CLI::App* command = app.add_subcommand("export", "Write a recording as CSV or HDF5 with a data dictionary, or as Motion-BIDS");
  command->add_option("file", o->file, "Recording")->required();
  command->add_option("--format", o->format, "csv, hdf5 or bids (Motion-BIDS)")->check(CLI::IsMember({"csv", "hdf5", "bids"}))->capture_default_str();
  command->add_option("--out", o->folder, "Folder to write to; made if it is not there")->required();
  command->add_flag("--json", o->json, "Print one JSON document and nothing else");
  command->callback([o, &action] { action.run = [o](const Streams& io) { return run(*o, io); }; });
}

}  // namespace filum
