// filum run TASK: one session without a browser.

#include <CLI/CLI.hpp>
#include <cinttypes>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "cli/live_session.h"
#include "cli/number_range.h"
#include "cli/options.h"
#include "cli/session_files.h"
#include "cli/tool_stream.h"

namespace filum {
namespace {

struct RunOptions {
  CommonOptions common;
  std::string task, input = "demo", model, record, forceps, code;
  bool real_time = false;
  double motion_scale = 1.0;
  double stiffness = 1.0;
  int stream_port = 0;     // of OpenIGTLink, 0 none
  double longest = LiveOptions{}.longest;  // [s]
};

std::string hash_text_of(std::uint64_t hash) {
  char text[17];
  std::snprintf(text, sizeof text, "%016" PRIx64, hash);
  return text;
}

void print_text(const LiveOutcome& outcome, const Streams& io) {
  const Result& r = outcome.result;
  std::fprintf(io.out, "%s: %s, %s\n", r.title.c_str(), r.finished ? "finished" : "not finished", r.passed ? "passed" : "not passed");
  if (r.pressure) {
    std::fprintf(io.out, "pressure: peak %.1f mmHg, dose %.1f mmHg min (%s)\n", r.pressure->peak / kMmHg, r.pressure->dose / (60.0 * kMmHg), r.pressure->limits.label.c_str());
  }
  if (r.has_knot) std::fprintf(io.out, "knot: %s\n", r.knot.knot_class.c_str());
  std::fprintf(io.out, "score %.1f of %.1f\n", r.total, r.max_total);
  for (const ScoreItem& item : r.items) {
    std::fprintf(io.out, "  %5.1f / %4.1f  %-16s %s\n", item.points, item.max_points, item.name.c_str(), item.why.c_str());
  }
  for (const std::string& line : r.verdict) std::fprintf(io.out, "%s\n", line.c_str());
  std::fprintf(io.out, "%.1f s of scene in %.1f s (real-time factor %.2f), %" PRIu64 " late steps, state %s\n", outcome.scene_seconds,
              outcome.wall_seconds, outcome.real_time_factor, outcome.overruns, hash_text_of(outcome.state_hash).c_str());
  for (const DeviceOutcome& d : outcome.devices) {
    std::fprintf(io.out, "%s: %" PRIu64 " samples received, %" PRIu64 " lost, %" PRIu64 " frames damaged, %" PRIu64 " samples refused\n", d.name.c_str(),
                 d.health.received, d.health.lost, d.health.corrupt, d.health.rejected);
  }
}

/// The keys are those of a device in the server's pictures.
nlohmann::ordered_json json_of(const DeviceOutcome& d) {
  return {{"name", d.name}, {"state", name_of(d.health.state)}, {"received", d.health.received}, {"lost", d.health.lost}, {"corrupt", d.health.corrupt}, {"rejected", d.health.rejected}};
}

int run(const RunOptions& o, const Streams& io) {
  if (!o.code.empty() && o.record.empty()) throw InputError("--code", "participant", o.code, "--record FILE beside it");
  Setup setup = load_setup(o.common.root, o.task, o.model, o.stiffness);
  InputDevices inputs = open_inputs(o.input, o.common.root, o.task, o.motion_scale, o.forceps);
  std::unique_ptr<Recorder> recorder;
  if (!o.record.empty()) recorder = make_recorder(o.record, setup, inputs.description, o.code, inputs.calibration);
  LiveOptions options;
  options.paced = o.real_time || !inputs.scripted;  // hands cannot be hurried
  options.longest = o.longest;
  options.recorder = recorder.get();
  std::unique_ptr<ToolStream> stream;
  if (o.stream_port > 0) {
    stream = std::make_unique<ToolStream>(o.stream_port);
    options.show = [&stream](const LiveView& view) { stream->send_all(view.observation); };
  }
  LiveSession session(std::move(setup), std::move(inputs), std::move(options));
  session.start();
  const LiveOutcome outcome = session.wait();
  if (o.common.json) {
    nlohmann::ordered_json document = result_document(outcome.result);
    document["real_time_factor"] = outcome.real_time_factor;
    document["overruns"] = outcome.overruns;
    document["steps"] = outcome.steps;
    document["scene_seconds"] = outcome.scene_seconds;
    document["state_hash"] = hash_text_of(outcome.state_hash);
    document["devices"] = nlohmann::ordered_json::array();
    for (const DeviceOutcome& d : outcome.devices) document["devices"].push_back(json_of(d));
    print_json(io.out, document);
  } else {
    print_text(outcome, io);
  }
  if (recorder && !recorder->status().healthy) {
    std::fprintf(io.err, "filum: recording %s: %s\n", o.record.c_str(), recorder->status().message.c_str());
    return kFailed;
  }
  return kDone;
}

}  // namespace

void add_run(CLI::App& app, Action& action) {
  auto o = std::make_shared<RunOptions>();
  CLI::App* command = app.add_subcommand("run", "Run a task without a browser and print its score");
  command->add_option("task", o->task, "Name of the task, e.g. knot-square (see filum list)")->required();
  command->add_option("--input", o->input, "demo, serial:PATH, haptic:[ADDRESS:]PORT, igtl:[ADDRESS:]PORT, several joined by +, a demonstration (*.yaml) or a recording")->capture_default_str();
  command->add_option("--model", o->model, "Suture, vessel or brain to use instead of the scene's: a file, a name of filum list, or a model.yaml of filum reconcile");
  command->add_option("--stiffness", o->stiffness, "Of the brain, times the model's: 0.1 to 10");
  command->add_option("--forceps", o->forceps, "Calibration of the forceps on serial:PATH (from filum calibrate forceps)");
  command->add_option("--record", o->record, "Store the session in this new file");
  command->add_option("--code", o->code, "Code of the participant for --record: letters, digits, - and _; never a name");
  command->add_option("--motion-scale", o->motion_scale, "Movement in the scene over that of the hand")->check(between(0.001, 10.0))->capture_default_str();
  command->add_option("--igtl-out", o->stream_port, "Send the tools' poses by OpenIGTLink from this port of this machine")->check(CLI::Range(1, 65535));
  command->add_flag("--real-time", o->real_time, "Keep to the clock instead of running as fast as possible");
  command->add_option("--longest", o->longest, "End after this much scene time [s]")->check(between(0.1, 36000.0))->capture_default_str();
  add_common(*command, o->common);
  command->callback([o, &action] { action.run = [o](const Streams& io) { return run(*o, io); }; });
}

}  // namespace filum
