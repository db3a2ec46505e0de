#pragma once
// Reads a scene (curricula/TASK/scene.yaml, format filum-scene/1) and what it names under models/ into a Model.

#include <memory>
#include <string>

#include "world/model.h"

namespace filum {

/// `model_file`: a suture file used in place of the scene's, "" for none. Throws InputError.
std::shared_ptr<const Model> load_model(const std::string& root, const std::string& task, const std::string& model_file);

/// models/suture/NAME.yaml, format filum-suture/1: each value with unit, source and uncertainty.
RodMaterial load_suture(const std::string& path, ContactMaterial& contact);

/// models/instrument/NAME.yaml, format filum-instrument/1.
InstrumentParameters load_instrument(const std::string& path);

}  // namespace filum
