#include "cli/session_files.h"

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/yaml_file.h"
#include "cli/options.h"
#include "cli/requests.h"
#include "cli/security.h"
#include "training/result_json.h"
#include "training/task_session.h"
#include "world/brain_model.h"
#include "world/model.h"

namespace filum {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kModelOverride = "models/override.yaml";
constexpr const char* kForceps = "models/forceps/in-use.yaml";
constexpr const char* kDial = "models/stiffness-dial.yaml";

std::string read_whole(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw InputError(file, "file", "nothing readable", "a model file");
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string new_folder() {
  std::string name = (fs::temp_directory_path() / "filum-recorded-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw InputError(name, "folder", "none", "a temporary folder that may be written");
  return name;
}

[[noreturn]] void refuse_damaged(const RecordingReader& recording, const std::vector<std::string>& damage) {
  std::string all;
  for (const std::string& one : damage) all += (all.empty() ? "" : "; ") + one;
  throw InputError(recording.file(), "recording", all, "an undamaged recording");
}

/// The files that stand in for those of the task: without one of them another scene would be stepped.
bool changes_the_scene(const std::string& damage) {
  for (const char* name : {kModelOverride, kDial})
    if (damage.find(name) != std::string::npos) return true;
  return false;
}

double dialled(const YamlNode& dial) { return dial.number("stiffness", Range::between(0.1, 10.0)); }

Setup setup_of(const RecordingReader& recording, const std::string& folder) {
  for (const std::string& one : recording.damaged_texts())
    if (changes_the_scene(one)) refuse_damaged(recording, {one});
  recording.write_sources(folder);
  const std::string model = folder + "/" + kModelOverride;
  const std::string dial = folder + "/" + kDial;
  double stiffness = 1.0;
  if (fs::exists(dial)) stiffness = dialled(YamlNode::load(dial));
  return load_setup(folder, recording.meta().task, fs::exists(model) ? model : "", stiffness);
}

/// Stored by an earlier program: what goes on through the join had a name that said something else.
void rename_flow(Json& leak) {
  constexpr const char* kEarlier = "flow_if_tight_ml_per_min";
  if (!leak.is_object() || !leak.contains(kEarlier)) return;
  leak["through_ml_per_min"] = leak[kEarlier];
  leak.erase(kEarlier);
}

std::string message_of(Json result, const std::string& session) {
  Json message = {{"type", "result"}, {"session", session.empty() ? Json(nullptr) : Json(session)}};
  for (const char* key : {"task", "title", "finished", "passed", "seconds", "score", "knot", "events", "series", "paths"}) {
    if (!result.contains(key)) return {};
    message[key] = std::move(result[key]);
  }
  for (const char* key : {"verdict", "pressure_map", "stitches", "spacings_m", "lapses", "lapse_rules", "leak", "clamps", "milking", "handling", "thrombosis_factors"})
    if (result.contains(key)) message[key] = std::move(result[key]);
  if (message.contains("leak")) rename_flow(message["leak"]);
  if (Json scales = scales_of(result); !scales.empty()) message["scales"] = std::move(scales);
  return json_text(message);
}

}  // namespace

std::unique_ptr<Recorder> make_recorder(const std::string& file, const Setup& setup, const std::string& input,
                                        const std::string& participant, const std::string& calibration) {
  const SceneDescription& scene = setup.model->description;
  RecorderOptions options;
  options.file = file;
  options.meta.program = program_text();
  options.meta.task = setup.task.name;
  options.meta.participant = participant;
  options.meta.input = input;
  options.meta.dt = scene.dt;
  options.meta.n_tools = scene.n_tools;
  options.sources = read_sources(setup.root);
  if (!setup.model_file.empty()) options.sources.push_back({kModelOverride, read_whole(setup.model_file)});
  if (!calibration.empty()) options.sources.push_back({kForceps, read_whole(calibration)});
  if (setup.stiffness != 1.0) {
    char text[48];
    std::snprintf(text, sizeof text, "stiffness: %.17g\n", setup.stiffness);
    options.sources.push_back({kDial, text});
  }
  if (const auto& brain = setup.model->brain; brain && !brain->mesh_file.empty()) {
    const std::string beside = setup.model_file.empty() ? "models/brain/" : "models/";
    options.sources.push_back({beside + brain->mesh_name, read_whole(brain->mesh_file)});
  }
  return std::make_unique<Recorder>(std::move(options));
}

Conditions read_conditions(const RecordingReader& recording) {
  const std::string& input = recording.meta().input;
  Conditions made;
  made.input = input.starts_with("demonstrat") ? "demo" : input == "pointer" ? "pointer" : "device";
  for (const SourceFile& source : recording.sources())
    if (source.path == kDial) made.stiffness = dialled(YamlNode::parse(source.text, kDial));
  RecordCursor<EventRecord> events = recording.events();
  if (EventRecord first; events.next_readable(first)) made.exam = first.name == "exam";
  return made;
}

RecordedSetup::RecordedSetup(const RecordingReader& recording) : folder_(new_folder()) {
  std::error_code ignored;
  try {
    setup_ = setup_of(recording, folder_);
  } catch (const InputError&) {
    fs::remove_all(folder_, ignored);
    if (const auto damage = recording.find_damage(); !damage.empty()) refuse_damaged(recording, damage);
    throw;
  } catch (...) {
    fs::remove_all(folder_, ignored);
    throw;
  }
}

RecordedSetup::~RecordedSetup() {
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

void require_steps(const RecordingReader& recording) {
  if (recording.last_step() > 0) return;
  const auto damage = recording.find_damage();
  if (!damage.empty()) refuse_damaged(recording, damage);
  throw InputError(recording.file(), "steps", "none", "at least one: there is nothing to replay");
}

int tell_damage(std::FILE* err, const std::string& file, const std::vector<std::string>& damage, int code) {
  for (const std::string& one : damage) std::fprintf(err, "filum: %s: recording: found %s, expected an undamaged recording\n", file.c_str(), one.c_str());
  return damage.empty() ? code : kBadInput;
}

Rescored rescore(const RecordingReader& recording) {
  require_steps(recording);
  const RecordedSetup recorded(recording);
  World world(recorded.setup().model);
  TaskSession task(recorded.setup().task, world.description());
  ReplayResult replayed =
      replay(recording, world, [&task](const StepRecord&, const Observation& o) { task.observe(o); }, true);
  return {finish_with_security(task, world), std::move(replayed)};
}

Json result_document(const Result& result) {
  Json document = Json::parse(result_json(result));
  document.erase("series");
  document.erase("paths");
  document.erase("pressure_map");
  return document;
}

std::string result_message(const Result& result, const std::string& session) {
  return message_of(Json::parse(result_json(result, false)), session);
}

std::string result_message(const std::string& stored_json, const std::string& session) {
  Json result = parsed_json(stored_json);
  return result.is_object() ? message_of(std::move(result), session) : std::string();
}

}  // namespace filum
