#pragma once
// The brain's part of the messages: surface, blades, veins and target of the scene; positions, pressure and exposure of a frame.

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "server/views.h"
#include "world/observation.h"

namespace filum {

/// null without a brain.
nlohmann::json brain_scene_json(const BrainDescription& brain, int n_tools);
nlohmann::json retraction_json(const RetractionView& r);
/// Text of the frame's value, null without a brain.
std::string brain_frame_text(const Observation& o);

}  // namespace filum
