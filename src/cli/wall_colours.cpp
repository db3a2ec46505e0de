#include "cli/wall_colours.h"

#include "training/pressure.h"
#include "world/vessel_model.h"

namespace filum {

WallColours::WallColours(std::shared_ptr<const Model> model) : model_(std::move(model)) {}

void WallColours::choose(const std::string& kind) { kind_ = kind == "strain" ? Kind::strain : kind == "pressure" ? Kind::pressure : Kind::none; }

OverlayView WallColours::view(const Observation& o) {
  const Kind kind = kind_;
  const auto& vessel = model_->vessel;
  if (kind == Kind::none || !vessel || o.tissue.n != vessel->mesh.n_nodes()) return {};
  if (!overlay_) overlay_ = std::make_unique<WallOverlay>(vessel->mesh, vessel->layers, model_->description.tissue.rest);
  if (kind == Kind::strain) {
    overlay_->strain(o.tissue.positions, values_);
    return {"strain", "%", 30.0, 100.0, &values_};
  }
  overlay_->pressure(o.tissue.positions, values_);
  return {"pressure", "mmHg", 150.0, 1.0 / kMmHg, &values_};
}

}  // namespace filum
