#pragma once
// `tissue:` of a scene, and models/track/NAME.yaml (format filum-track/1): how tissue lets a needle through. Test: vessel_file_test.

#include <string>

#include "base/yaml_file.h"
#include "world/model.h"
#include "world/vessel_model.h"

namespace filum {

TrackMaterial load_track(const std::string& path);

/// Whether a model file is a preset of models/vessel (by its format); an empty path is none.
bool is_vessel(const std::string& path);

/// `vessel_file`: a preset to take instead of the one that the scene names, or empty.
/// `tissue: { kind: card, ... }` or `{ kind: vessel, preset: human-digital-artery, ... }`. The scene's needle is known. Throws InputError.
void read_tissue(const std::string& root, const YamlNode& node, const std::string& vessel_file, Model& m);

}  // namespace filum
