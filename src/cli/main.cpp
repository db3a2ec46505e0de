// The program: reads which subcommand is wanted and hands over to its file.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <new>

#include "base/error.h"
#include "cli/options.h"

int main(int argc, char** argv) {
  CLI::App app{"Filum: a microsurgery skills trainer"};
  app.name("filum");
  app.require_subcommand(1);
  app.set_version_flag("--version", filum::program_text());
  filum::Action action;
  filum::add_train(app, action);
  filum::add_run(app, action);
  filum::add_replay(app, action);
  filum::add_score(app, action);
  filum::add_export(app, action);
  filum::add_list(app, action);
  filum::add_validate(app, action);
  filum::add_bench(app, action);
  filum::add_analyse(app, action);
  filum::add_calibrate(app, action);
  filum::add_doctor(app, action);
  filum::add_reconcile(app, action);
  filum::add_import(app, action);
  filum::add_mesh(app, action);
  const auto subcommands = app.get_subcommands([](CLI::App*) { return true; });
  const auto named = [&](const CLI::App* sub) { return sub->get_name() == argv[1]; };
  if (argc > 1 && argv[1][0] != '-' && std::none_of(subcommands.begin(), subcommands.end(), named)) {
    std::fprintf(stderr, "filum: subcommand: found %s, expected one of those that `filum --help` lists\n", argv[1]);
    return filum::kBadInput;
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? filum::kDone : filum::kBadInput;
  }
  try {
    return action.run();
  } catch (const filum::InputError& error) {
    std::fprintf(stderr, "filum: %s\n", error.what());
    return filum::kBadInput;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "filum: %s\n", error.what());
    return filum::kFailed;
  }
}
