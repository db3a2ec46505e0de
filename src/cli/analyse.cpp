// filum analyse FILE...: tremor, smoothness and grasp force of recordings, and how they go together.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>

#include "analysis/report_page.h"
#include "base/error.h"
#include "cli/options.h"
#include "cli/session_files.h"
#include "session/export.h"

namespace filum {
namespace {

struct AnalyseOptions {
  std::vector<std::string> files, reference;
  std::string clamped, plot, page;
  bool json = false;
};

const std::vector<double>* column(const Table& table, const std::string& name) {
  for (const Column& c : table.columns)
    if (c.name == name) return std::get_if<std::vector<double>>(&c.values);
  return nullptr;
}

/// Where no device measured the squeeze, the simulated one is taken, by stepping the recording again.
void add_simulated_grip(const RecordingReader& recording, RecordedSession& session) {
  const auto measured = [](const ToolSeries& t) { return t.grip.source != "none"; };
  if (std::any_of(session.tools.begin(), session.tools.end(), measured)) return;
  const RecordedSetup recorded(recording);
  World world(recorded.setup().model);
  const Table table = simulated_table(recording, world);
  const std::vector<double>* time = column(table, "time");
  for (ToolSeries& tool : session.tools) {
    const std::vector<double>* force = column(table, "tool" + std::to_string(tool.tool) + "_grip_force");
    if (!time || !force) continue;
    tool.grip.clock = tool.grip.scene = *time;
    tool.grip.force = *force;
    tool.grip.source = "simulation";
  }
}

}  // namespace

RecordedSession open_session(const std::string& file) {
  const RecordingReader recording(file);
  RecordedSession session = read_session(recording);
  add_simulated_grip(recording, session);
  return session;
}

namespace {

std::string shown(const nlohmann::ordered_json& value, double scale) {
  if (!value.is_number()) return "not resolved";
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", scale * value.get<double>());
  return text;
}

void print_tremor(const nlohmann::ordered_json& t, const Streams& io) {
  std::fprintf(io.out, "tremor, tool %d, %s space, %s: ", t["tool"].get<int>(), t["space"].get<std::string>().c_str(),
              t["window"].get<std::string>().c_str());
  if (!t["resolved"].get<bool>()) {
    std::fprintf(io.out, "not resolved: %s\n", t.value("why", "").c_str());
  } else {
    std::fprintf(io.out, "peak %s Hz, width %s Hz\n", shown(t["peak_hz"], 1.0).c_str(), shown(t["half_power_width_hz"], 1.0).c_str());
  }
  if (!t["measured"].get<bool>()) return;
  for (const auto& band : t["bands"])
    std::fprintf(io.out, "  %4.0f-%2.0f Hz  rms %s um  (noise floor %s um)\n", band["from_hz"].get<double>(), band["to_hz"].get<double>(),
                shown(band["rms_m"], 1e6).c_str(), shown(band["noise_floor_rms_m"], 1e6).c_str());
}

void print_text(const nlohmann::ordered_json& report, const Streams& io) {
  for (const auto& t : report["tremor"]) print_tremor(t, io);
  for (const auto& s : report["smoothness"]) {
    if (!s.contains("sparc")) continue;
    std::fprintf(io.out, "smoothness, tool %d, %s space: SPARC %s, LDLJ %s (median of %d movements)\n", s["tool"].get<int>(),
                s["space"].get<std::string>().c_str(), shown(s["sparc"]["median"], 1.0).c_str(),
                shown(s["ldlj"]["median"], 1.0).c_str(), s["sparc"]["n"].get<int>());
  }
  for (const auto& g : report["grasp_force"]) {
    if (!g.contains("summary")) continue;
    std::fprintf(io.out, "grasp force, tool %d (%s): %d grasps, peak %s N, excess over the slip limit %s N\n", g["tool"].get<int>(),
                g["source"].get<std::string>().c_str(), g["grasps"].get<int>(), shown(g["summary"]["peak_n"]["median"], 1.0).c_str(),
                shown(g["summary"]["excess_over_slip_limit_n"]["median"], 1.0).c_str());
  }
}

bool is_recording(const std::string& path) {
  constexpr std::string_view kHead = "SQLite format 3";
  std::string head(kHead.size(), '\0');
  return std::ifstream(path, std::ios::binary).read(head.data(), static_cast<std::streamsize>(head.size())) && head == kHead;
}

void write(const char* option, const std::string& path, const std::string& text) {
  if (is_recording(path)) throw InputError(option, "file", path + ", which is a recording", "another name: a recording is never written over");
  std::ofstream file(path);
  file << text;
  if (!file.flush()) throw InputError(option, "file", path, "a file that can be written");
}

/// Names all that is damaged in the recordings on `err`, and in `damage`. Exit code: kBadInput where anything is.
int tell_all_damage(const std::vector<std::string>& files, std::FILE* err, nlohmann::ordered_json& damage) {
  int code = kDone;
  damage = nlohmann::ordered_json::array();
  for (const std::string& file : files) {
    const std::vector<std::string> found = RecordingReader(file).find_damage();
    for (const std::string& one : found) damage.push_back(file + ": " + one);
    code = tell_damage(err, file, found, code);
  }
  return code;
}

int run(const AnalyseOptions& o, const Streams& io) {
  AnalysisInput input;
  for (const std::string& file : o.files) input.sessions.push_back(open_session(file));
  if (!o.clamped.empty()) input.clamped = open_session(o.clamped);
  for (const std::string& file : o.reference) input.reference.push_back(open_session(file));
  AnalysisReport report = analyse(input, program_text());
  std::vector<std::string> all = o.files;
  all.insert(all.end(), o.reference.begin(), o.reference.end());
  if (!o.clamped.empty()) all.push_back(o.clamped);
  const int code = tell_all_damage(all, io.err, report.json["damage"]);
  if (!o.plot.empty()) write("--plot", o.plot, scatter_svg(report.panels, o.files));
  if (!o.page.empty()) write("--page", o.page, report_page(report));
  if (o.json) {
    print_json(io.out, report.json);
  } else {
    print_text(report.json, io);
  }
  return code;
}

}  // namespace

void add_analyse(CLI::App& app, Action& action) {
  auto o = std::make_shared<AnalyseOptions>();
  CLI::App* command = app.add_subcommand("analyse", "Tremor, smoothness and grasp force of recordings");
  command->add_option("files", o->files, "Recordings; several are also correlated with one another")->required();
  command->add_option("--clamped", o->clamped, "Recording of the same device with the tool clamped: its noise floor");
  command->add_option("--reference", o->reference, "Recordings of experts that the bands of grasp force come from");
  command->add_option("--plot", o->plot, "Write scatter plots to this SVG file");
  command->add_option("--page", o->page, "Write the result as one HTML page to this file");
  command->add_flag("--json", o->json, "Print one JSON document and nothing else");
  command->callback([o, &action] { action.run = [o](const Streams& io) { return run(*o, io); }; });
}

}  // namespace filum
