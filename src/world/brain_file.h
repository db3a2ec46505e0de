#pragma once
// Reads scenes with a brain (curricula/TASK/scene.yaml, format filum-brain-scene/1) and what they name: models/brain/NAME.yaml
// (filum-brain/1), models/spatula/NAME.yaml (filum-spatula/1). Tests: brain_file_test, brain_scene_test.

#include <memory>
#include <string>

#include "world/brain_model.h"
#include "world/model.h"

namespace filum {

inline constexpr const char* kBrainScene = "filum-brain-scene/1";

/// `model_file`: a brain used in place of the scene's, "" for none. Throws InputError.
std::shared_ptr<const Model> load_brain_scene(const std::string& root, const std::string& task, const std::string& model_file);
BladeShape load_blade(const std::string& path);

}  // namespace filum
