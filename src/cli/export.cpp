// filum export FILE: a recording as tables for other programs.

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/out_folder.h"
#include "cli/options.h"
#include "cli/session_files.h"
#include "session/export.h"

namespace filum {
namespace {

struct ExportOptions {
  std::string file, format = "csv", folder;
  bool json = false;
};

void print_files(const std::vector<std::string>& files, const std::vector<std::string>& damage, bool json, const Streams& io) {
  if (json) {
    print_json(io.out, {{"files", files}, {"damage", damage}});
  } else {
    for (const std::string& file : files) std::fprintf(io.out, "%s\n", file.c_str());
  }
}

/// What can be read of a recording: without the simulated table where the files of its scene are damaged.
std::vector<Table> readable_tables(const RecordingReader& recording, bool damaged) {
  std::vector<Table> tables = recorded_tables(recording);
  try {
    const RecordedSetup recorded(recording);
    World world(recorded.setup().model);
    tables.push_back(simulated_table(recording, world));
  } catch (const InputError&) {
    if (!damaged) throw;
  }
  return tables;
}

int run(const ExportOptions& o, const Streams& io) {
  require_out_folder("--out", o.folder);
  if (o.format != "bids") require_no_export(o.folder, o.format);  // before the recording is stepped again
  const RecordingReader recording(o.file);
  const std::vector<std::string> damage = recording.find_damage();
  std::vector<std::string> files;
  if (o.format == "bids") {
    files = export_bids(recording, o.folder);
  } else {
    const std::vector<Table> tables = readable_tables(recording, !damage.empty());
    files = o.format == "csv" ? export_csv(tables, recording.meta(), o.folder) : export_hdf5(tables, recording.meta(), o.folder);
  }
  print_files(files, damage, o.json, io);
  return tell_damage(io.err, o.file, damage, kDone);
}

}  // namespace

void add_export(CLI::App& app, Action& action) {
  auto o = std::make_shared<ExportOptions>();
  CLI::App* command = app.add_subcommand("export", "Write a recording as CSV or HDF5 with a data dictionary, or as Motion-BIDS");
  command->add_option("file", o->file, "Recording")->required();
  command->add_option("--format", o->format, "csv, hdf5 or bids (Motion-BIDS)")->check(CLI::IsMember({"csv", "hdf5", "bids"}))->capture_default_str();
  command->add_option("--out", o->folder, "Folder to write to, made if it is not there; an export in it is never written over (bids: joined)")->required();
  command->add_flag("--json", o->json, "Print one JSON document and nothing else");
  command->callback([o, &action] { action.run = [o](const Streams& io) { return run(*o, io); }; });
}

}  // namespace filum
