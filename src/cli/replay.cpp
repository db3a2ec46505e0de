// filum replay FILE: steps a recording anew and compares every state hash.

#include <CLI/CLI.hpp>
#include <cinttypes>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/options.h"
#include "cli/session_files.h"

namespace filum {
namespace {

struct ReplayOptions {
  std::string file;
  bool json = false;
};

nlohmann::ordered_json json_of(const RecordingReader& recording, const ReplayResult& result, const std::vector<std::string>& damage) {
  nlohmann::ordered_json document = {{"identical", result.identical}, {"first_difference", nullptr}, {"steps", result.steps}};
  if (result.first_difference) document["first_difference"] = {{"step", result.first_difference->step}, {"array", result.first_difference->array}};
  document["recorded_by"] = recording.meta().program;
  document["finished"] = recording.finished();
  document["damage"] = damage;
  return document;
}

void print_text(const ReplayResult& result, const Streams& io) {
  if (result.first_difference) {
    std::fprintf(io.out, "first difference at step %" PRIu64 " in array %s\n", result.first_difference->step, result.first_difference->array.c_str());
  } else {
    std::fprintf(io.out, "identical: %" PRIu64 " steps%s\n", result.steps, result.damage.empty() ? "" : ", the last that can be read");
  }
}

int run(const ReplayOptions& o, const Streams& io) {
  const RecordingReader recording(o.file);
  require_steps(recording);
  const RecordedSetup recorded(recording);
  World world(recorded.setup().model);
  const ReplayResult result = replay(recording, world);
  if (recording.meta().program != program_text()) {
    std::fprintf(io.err, "filum: recorded by %s, replayed by %s: equal states are promised within one build only\n",
                 recording.meta().program.c_str(), program_text().c_str());
  }
  const std::vector<std::string> damage = recording.find_damage();
  if (o.json)
    print_json(io.out, json_of(recording, result, damage));
  else
    print_text(result, io);
  return tell_damage(io.err, o.file, damage, result.identical ? kDone : kFailed);
}

}  // namespace

void add_replay(CLI::App& app, Action& action) {
  auto o = std::make_shared<ReplayOptions>();
  CLI::App* command = app.add_subcommand("replay", "Step a recording anew and compare every state");
  command->add_option("file", o->file, "Recording")->required();
  command->add_flag("--json", o->json, "Print one JSON document and nothing else");
  command->callback([o, &action] { action.run = [o](const Streams& io) { return run(*o, io); }; });
}

}  // namespace filum
