// filum list: what there is to run.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "cli/options.h"
#include "cli/setup.h"
#include "reconcile/catalogue.h"

namespace filum {
namespace {

// The physical effects that the world is made of, each one header below src/physics; those of reconcile come from its catalogue.
constexpr const char* kEffects[] = {"elastic_rod", "rod_contact", "friction", "rod_obstacle", "thread_grasp", "instrument",
                                    "linear_fem", "spatula_contact", "needle", "needle_track", "rod_tether",
                                    "vessel_wall", "hyperelastic", "wall_meeting", "vessel_leak", "vessel_flow", "pellet", "tissue_law", "pore_flow"};

std::string kind_of(const std::string& root, const std::string& model, std::vector<std::string>& problems) {
  try {
    return model_kind(root, model);
  } catch (const InputError& error) {
    problems.emplace_back(error.what());
    return "";
  }
}

std::string said_of(const std::string& kind) {
  if (is_for_tasks(kind)) return kind + ", for --model";
  if (kind == "baseline") return "baseline that filum reconcile starts from, not for --model";
  return kind + ", part of scenes";
}

int run(const CommonOptions& o, const Streams& io) {
  using Json = nlohmann::ordered_json;
  if (!std::filesystem::is_directory(o.root + "/curricula") || !std::filesystem::is_directory(o.root + "/models"))
    throw InputError("--root", "folder", o.root, "a folder with models/ and curricula/");
  std::vector<std::string> problems;
  Json tasks = Json::array();
  Json curricula = Json::array();
  for (const Task& task : load_tasks(o.root, problems)) {
    const std::string curriculum = curriculum_of(o.root, task.name);
    const bool shown = std::filesystem::exists(demonstration_file(o.root, task.name));
    tasks.push_back({{"name", task.name}, {"title", task.title}, {"demonstration", shown}, {"demonstration_only", task.demonstration_only}, {"curriculum", curriculum}});
    curricula.push_back(task.name);
    if (!curriculum.empty() && std::find(curricula.begin(), curricula.end(), Json(curriculum)) == curricula.end()) curricula.push_back(curriculum);
  }
  Json rigs = Json::array(), effects = Json::array();
  for (const auto& rig : reconcile::rigs()) rigs.push_back(rig.name);
  for (const auto& effect : reconcile::effects()) effects.push_back(effect.name);
  for (const char* effect : kEffects) effects.push_back(effect);
  const auto models = model_names(o.root);
  Json details = Json::array();
  for (const std::string& model : models) {
    const std::string kind = kind_of(o.root, model, problems);
    details.push_back({{"name", model}, {"kind", kind}, {"for_tasks", is_for_tasks(kind)}});
  }
  for (const std::string& problem : problems) std::fprintf(io.err, "filum: %s\n", problem.c_str());
  if (o.json) {
    print_json(io.out, {{"tasks", tasks}, {"models", models}, {"model_details", details}, {"curricula", curricula}, {"rigs", rigs}, {"effects", effects}});
  } else {
    std::fprintf(io.out, "tasks\n");
    for (const Json& task : tasks) {
      std::fprintf(io.out, "  %-18s %s\n", task["name"].get<std::string>().c_str(), task["title"].get<std::string>().c_str());
    }
    std::fprintf(io.out, "models\n");
    for (const Json& model : details) std::fprintf(io.out, "  %-30s %s\n", model["name"].get<std::string>().c_str(), said_of(model["kind"]).c_str());
    std::fprintf(io.out, "effects\n");
    for (const Json& effect : effects) std::fprintf(io.out, "  %s\n", effect.get<std::string>().c_str());
    std::fprintf(io.out, "rigs of reconcile\n");
    for (const Json& rig : rigs) std::fprintf(io.out, "  %s\n", rig.get<std::string>().c_str());
  }
  return problems.empty() ? kDone : kBadInput;
}

}  // namespace

void add_list(CLI::App& app, Action& action) {
  auto o = std::make_shared<CommonOptions>();
  CLI::App* command = app.add_subcommand("list", "List tasks, models and effects");
  add_common(*command, *o);
  command->callback([o, &action] { action.run = [o](const Streams& io) { return run(*o, io); }; });
}

}  // namespace filum
