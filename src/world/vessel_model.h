#pragma once
// Tissue to be stitched: the constant part of a scene, and its state.

#include <string>
#include <vector>

#include "physics/needle_track.h"
#include "world/vessel_contact.h"

namespace filum {

struct VesselModel {
  std::string name, kind = "card";
  VesselMesh mesh;
  std::vector<WallLayer> layers;
  WallOptions wall;
  TrackMaterial track;
  double thickness = 0.0;             // [m]
  Vec3 cut_along = Vec3::UnitX();     // unit, direction of the cut at rest
};

struct VesselState {
  WallState wall;
  TrackState tracks;
  TouchState touches;
};

}  // namespace filum
