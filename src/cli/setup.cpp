#include "cli/setup.h"

#include <algorithm>
#include <filesystem>

#include "base/error.h"
#include "base/file_kind.h"
#include "base/yaml_file.h"
#include "training/needle_task.h"
#include "world/brain_model.h"
#include "world/model.h"
#include "world/task_folder.h"
#include "world/vessel_model.h"

namespace filum {
namespace {

namespace fs = std::filesystem;

std::string task_file(const std::string& root, const std::string& task) { return root + "/" + task_folder(root, task) + "/task.yaml"; }

/// The model with both moduli of its brain multiplied.
std::shared_ptr<const Model> turned(std::shared_ptr<const Model> model, double stiffness) {
  if (stiffness == 1.0) return model;
  if (!model->brain) throw InputError("--stiffness", "stiffness", std::to_string(stiffness), "a task of brain retraction");
  if (!(stiffness >= 0.1 && stiffness <= 10.0)) throw InputError("--stiffness", "stiffness", std::to_string(stiffness), "0.1 to 10 times the model's");
  auto brain = std::make_shared<BrainModel>(*model->brain);
  for (FemMaterial& tissue : brain->regions) tissue.young *= stiffness;
  auto m = std::make_shared<Model>(*model);
  m->brain = std::move(brain);
  return m;
}

bool asks_to_cut(const Task& task) {
  using Goal = NeedleGoal::Kind;
  if (task.needle != nullptr) return std::any_of(task.needle->goals.begin(), task.needle->goals.end(), [](const NeedleGoal& g) { return g.kind == Goal::cut; });
  return std::any_of(task.steps.begin(), task.steps.end(), [](const TaskStep& s) { return s.kind == StepKind::cut; });
}

/// Whether the scene has the tools that the steps are made with. Throws InputError.
void check_tools(const std::string& file, const Task& task, const Model& model) {
  const auto blades = [](const InstrumentParameters& p) { return p.kind == "scissors"; };
  if (asks_to_cut(task) && std::none_of(model.instruments.begin(), model.instruments.end(), blades))
    throw InputError(file, "steps", "cut", "scissors among the instruments of its scene.yaml");
  if (task.needle == nullptr) return;
  const bool loose = model.vessel != nullptr && model.vessel->adventitia;
  for (const NeedleGoal& g : task.needle->goals) {
    if (g.kind == NeedleGoal::Kind::grasp && !loose) throw InputError(file, "steps", "grasp", "a vessel with adventitia as the tissue of its scene.yaml");
    if (g.tool < 0 || g.tool >= static_cast<int>(model.instruments.size()))
      throw InputError(file, "tool", std::to_string(g.tool), "one of the " + std::to_string(model.instruments.size()) + " instruments of its scene.yaml, from 0");
  }
}

}  // namespace

std::vector<std::string> task_names(const std::string& root) {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& [name, folder] : task_folders(root))  // in order
    if (fs::is_regular_file(fs::path(root) / folder / "task.yaml", error)) names.push_back(name);
  return names;
}

namespace {

/// A model is a file or, as `filum list` prints them, a name below models/.
std::string model_path(const std::string& root, const std::string& model) {
  const std::string named = root + "/models/" + model + ".yaml";
  return !model.empty() && !is_there(model) && is_there(named) ? named : model;
}

}  // namespace

Setup load_setup(const std::string& root, const std::string& task, const std::string& model, double stiffness) {
  const std::vector<std::string> names = task_names(root);
  if (names.empty()) throw InputError("--root", "curricula", root, "a folder with models/ and curricula/");
  if (std::find(names.begin(), names.end(), task) == names.end()) {
    std::string all;
    for (const std::string& name : names) all += (all.empty() ? "" : ", ") + name;
    throw InputError("curricula", "task", task, "one of: " + all);
  }
  const std::string model_file = model_path(root, model);
  Setup setup{root, model_file, turned(load_model(root, task, model_file), stiffness), load_task(task_file(root, task)), stiffness};
  check_tools(task_file(root, task), setup.task, *setup.model);
  return setup;
}

std::vector<Chapter> load_chapters(const std::string& root, std::vector<std::string>& problems) {
  const std::string file = root + "/curricula/course.yaml";
  std::vector<Chapter> course;
  std::error_code error;
  try {
    if (fs::exists(file, error)) course = load_course(file);
  } catch (const InputError& wrong) {
    problems.emplace_back(wrong.what());
  }
  return chapters_of(course, task_names(root));
}

std::vector<Task> load_tasks(const std::string& root, const Chapter& chapter, std::vector<std::string>& problems) {
  std::vector<Task> tasks;
  for (const std::string& name : chapter.tasks) {
    try {
      tasks.push_back(load_task(task_file(root, name)));
    } catch (const InputError& error) {
      problems.emplace_back(error.what());
    }
  }
  return tasks;
}

std::vector<Task> load_tasks(const std::string& root, std::vector<std::string>& problems) {
  std::vector<Task> tasks;
  for (const Chapter& chapter : load_chapters(root, problems))
    for (Task& task : load_tasks(root, chapter, problems)) tasks.push_back(std::move(task));
  return tasks;
}

std::vector<std::string> model_names(const std::string& root) {
  std::vector<std::string> names;
  std::error_code error;
  const fs::path folder = fs::path(root) / "models";
  for (fs::recursive_directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    if (at->path().extension() == ".yaml") names.push_back(fs::relative(at->path(), folder).replace_extension().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::string model_kind(const std::string& root, const std::string& name) {
  const YamlNode file = YamlNode::load(root + "/models/" + name + ".yaml");
  if (!file.has("format")) return "";
  const std::string format = file.text("format"), before = "filum-";  // filum-KIND/1
  if (format.starts_with("filum-vessel/") && file.text("kind") == "card") return "card";
  return format.starts_with(before) ? format.substr(before.size(), format.find('/') - before.size()) : "";
}

bool is_for_tasks(const std::string& kind) { return kind == "suture" || kind == "brain" || kind == "vessel"; }

std::string demonstration_file(const std::string& root, const std::string& task) {
  return root + "/" + task_folder(root, task) + "/demonstration.yaml";
}

std::string curriculum_of(const std::string& root, const std::string& task) {
  const fs::path above = fs::path(task_folder(root, task)).parent_path().filename();
  return above == "curricula" ? std::string() : above.string();
}

}  // namespace filum
