#pragma once
// A task made ready: its scene and its rules, read from models/ and curricula/.

#include <memory>
#include <string>
#include <vector>

#include "training/course.h"
#include "training/task.h"
#include "world/world.h"

namespace filum {

struct Setup {
  std::string root;
  std::string model_file;  // empty: the scene's own
  std::shared_ptr<const Model> model;
  Task task;
  double stiffness = 1.0;  // of a brain, times the model's: the surgeon's dial
};

/// `model`: a file, or its name below models/ without .yaml. Throws InputError; an unknown task is answered with the names of those there are, a task whose steps want a tool that its scene lacks is refused.
Setup load_setup(const std::string& root, const std::string& task, const std::string& model = "", double stiffness = 1.0);

/// Names of the folders below curricula/ that hold a task, in order.
std::vector<std::string> task_names(const std::string& root);

/// Chapters of the course (curricula/course.yaml) with the tasks that there are; where it cannot be read, one chapter and a problem.
std::vector<Chapter> load_chapters(const std::string& root, std::vector<std::string>& problems);

/// The tasks of a chapter that can be read; those that cannot are named in `problems`.
std::vector<Task> load_tasks(const std::string& root, const Chapter& chapter, std::vector<std::string>& problems);
/// All tasks that can be read, in the order of the course; those that cannot are left out and named in `problems`.
std::vector<Task> load_tasks(const std::string& root, std::vector<std::string>& problems);

/// Names of the model files, "suture/10-0-nylon".
std::vector<std::string> model_names(const std::string& root);

/// What a model file is, from its format: "suture", "brain", "vessel" (for `--model` of tasks that have one), "baseline" (where `filum reconcile`
/// starts; no task takes it), else the part of a scene it describes; "" if it has no format.
std::string model_kind(const std::string& root, const std::string& name);
/// Whether `--model` of `filum run` and `train` takes files of this kind.
bool is_for_tasks(const std::string& kind);

std::string demonstration_file(const std::string& root, const std::string& task);

/// "research" for a task in curricula/research, empty for one that belongs to none.
std::string curriculum_of(const std::string& root, const std::string& task);

}  // namespace filum
