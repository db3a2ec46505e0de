#pragma once
// The needle's and the tissue's part of the messages.

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "server/views.h"
#include "training/stitch_guide.h"
#include "world/observation.h"

namespace filum {

/// null without a needle, without tissue.
nlohmann::json needle_scene_json(const NeedleDescription& needle);
nlohmann::json tissue_scene_json(const TissueDescription& tissue);
nlohmann::json guide_json(const StitchGuide& guide);
/// Text of the frame's values, null without.
std::string needle_frame_text(const NeedleObservation& needle);
std::string tissue_frame_text(const TissueObservation& tissue);
std::string overlay_text(const OverlayView& overlay);

}  // namespace filum
