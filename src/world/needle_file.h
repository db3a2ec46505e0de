#pragma once
// models/needle/NAME.yaml, format filum-needle/1, and where a scene puts the needle.

#include <memory>
#include <string>

#include "base/yaml_file.h"
#include "physics/needle_shape.h"
#include "world/model.h"

namespace filum {

NeedleShape load_needle(const std::string& path);

/// `needle: { model, normal, side }` of a scene: the needle goes on where the thread's path ends, in the plane given by its
/// normal; `thread_path` is known. Throws InputError.
void read_needle(const std::string& root, const YamlNode& node, Model& m);

}  // namespace filum
