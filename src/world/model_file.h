#pragma once
// What the files of models and scenes have in common. All throw InputError, which names file, field, value and what was expected.

#include <string>

#include "base/pose.h"
#include "base/yaml_file.h"

namespace filum {

/// The file, if its field `format` says `format`.
YamlNode open_model_file(const std::string& path, const std::string& format);

/// A measured quantity { value, uncertainty, source }: no number stands alone. `unit` as in YamlNode::quantity; the value in SI.
double measured(const YamlNode& node, const std::string& key, const std::string& unit, const Range& range);

/// A point [m] within a metre of the origin: no bench is larger, a slip of unit is.
Vec3 read_point(const YamlNode& node, const std::string& key);

/// A unit vector: three numbers that are not all zero.
Vec3 read_direction(const YamlNode& node, const std::string& key);

/// { p, handle, opening }: origin [m] in W, direction of the frame's z axis, and one that shows the side its x axis points to.
Pose read_pose(const YamlNode& node);

}  // namespace filum
