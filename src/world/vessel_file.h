#pragma once
// `tissue:` of a scene, and models/track/NAME.yaml (format filum-track/1): how tissue lets a needle through.

#include <string>

#include "base/yaml_file.h"
#include "world/model.h"
#include "world/vessel_model.h"

namespace filum {

TrackMaterial load_track(const std::string& path);

/// `tissue: { kind: card, ... }` or `{ kind: vessel, preset: human-digital-artery, ... }`. The scene's needle is known. Throws InputError.
void read_tissue(const std::string& root, const YamlNode& node, Model& m);

}  // namespace filum
