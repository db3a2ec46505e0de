// filum score FILE: replays a recording and scores it anew.

#include <CLI/CLI.hpp>
#include <cinttypes>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/options.h"
#include "cli/session_files.h"

namespace filum {
namespace {

struct ScoreOptions {
  std::string file;
  bool json = false;
};

int run(const ScoreOptions& o, const Streams& io) {
  const RecordingReader recording(o.file);
  const Rescored rescored = rescore(recording);
  const Result& r = rescored.result;
  const std::vector<std::string> damage = recording.find_damage();
  const int code = tell_damage(io.err, o.file, damage, kDone);
  if (o.json) {
    nlohmann::ordered_json document = result_document(r);
    document["replay_identical"] = rescored.replay.identical;
    document["damage"] = damage;
    print_json(io.out, document);
    return code;
  }
  if (!rescored.replay.damage.empty()) {
    std::fprintf(io.err, "filum: the score is of the %" PRIu64 " steps that can be read\n", rescored.replay.steps);
  } else if (!rescored.replay.identical) {
    std::fprintf(io.err, "filum: this build steps the recording differently; the score is of what it computes\n");
  }
  const std::string knot = r.has_knot ? ", knot " + r.knot.knot_class : "";
  std::fprintf(io.out, "%s: %s%s, %.1f of %.1f points\n", r.title.c_str(), r.passed ? "passed" : "not passed", knot.c_str(), r.total, r.max_total);
  for (const ScoreItem& item : r.items) {
    std::fprintf(io.out, "  %5.1f / %4.1f  %-16s %s\n", item.points, item.max_points, item.name.c_str(), item.why.c_str());
  }
  for (const std::string& line : r.verdict) std::fprintf(io.out, "%s\n", line.c_str());
  return code;
}

}  // namespace

void add_score(CLI::App& app, Action& action) {
  auto o = std::make_shared<ScoreOptions>();
  CLI::App* command = app.add_subcommand("score", "Score a recording anew");
  command->add_option("file", o->file, "Recording")->required();
  command->add_flag("--json", o->json, "Print one JSON document and nothing else");
  command->callback([o, &action] { action.run = [o](const Streams& io) { return run(*o, io); }; });
}

}  // namespace filum
