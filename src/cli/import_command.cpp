// filum import: published tables turned into datasets for reconcile.

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "base/out_folder.h"
#include "cli/options.h"
#include "reconcile/importer.h"

namespace filum {

void add_import(CLI::App& app, Action& action) {
  struct Options {
    std::string kind, folder, out;
  };
  auto o = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("import", "Turn published tables into datasets for reconcile");
  command->add_option("kind", o->kind, "brain-budday2017, muscle-vanloocke or loadcells-fareke")->required();
  command->add_option("folder", o->folder, "Folder of the tables")->required();
  command->add_option("--out", o->out, "Folder for the datasets")->required();
  command->callback([o, &action] {
    action.run = [o](const Streams& io) {
      require_out_folder("--out", o->out);
      for (const std::string& name : reconcile::import_data(o->kind, o->folder, o->out)) std::fprintf(io.out, "%s/%s\n", o->out.c_str(), name.c_str());
      return static_cast<int>(kDone);
    };
  });
}

}  // namespace filum
