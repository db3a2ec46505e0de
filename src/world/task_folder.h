#pragma once
// Where a task lies: curricula/TASK, or curricula/CURRICULUM/TASK for tasks that belong together (curricula/research).

#include <algorithm>
#include <filesystem>
#include <map>
#include <string>

namespace filum {

/// Folders of all tasks below root by the task's name, relative to root: {"trace": "curricula/research/trace"}. Of two with one name the
/// one that comes first in the alphabet is taken.
inline std::map<std::string, std::string> task_folders(const std::string& root) {
  namespace fs = std::filesystem;
  std::map<std::string, std::string> found;
  std::error_code error;
  const auto add = [&](const fs::path& folder) {
    if (!fs::is_regular_file(folder / "scene.yaml", error)) return false;
    const std::string name = folder.filename().string(), place = folder.lexically_relative(root).generic_string();
    const auto [at, fresh] = found.emplace(name, place);
    if (!fresh) at->second = std::min(at->second, place);
    return true;
  };
  for (const auto& entry : fs::directory_iterator(fs::path(root) / "curricula", error)) {
    if (!entry.is_directory(error) || add(entry.path())) continue;
    for (const auto& inner : fs::directory_iterator(entry.path(), error)) add(inner.path());
  }
  return found;
}

/// "curricula/trace" or "curricula/research/trace"; empty if there is no such task.
inline std::string task_folder(const std::string& root, const std::string& task) {
  const std::string plain = "curricula/" + task;
  std::error_code error;
  if (std::filesystem::is_regular_file(std::filesystem::path(root) / plain / "scene.yaml", error)) return plain;
  const auto all = task_folders(root);
  const auto at = all.find(task);
  return at == all.end() ? std::string() : at->second;
}

}  // namespace filum
