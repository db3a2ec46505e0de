#pragma once
// Tissue to be stitched: the constant part of a scene.

#include <numbers>
#include <string>
#include <vector>

#include "physics/needle_track.h"
#include "physics/vessel_clamp.h"
#include "physics/vessel_flow.h"
#include "physics/vessel_wall.h"

namespace filum {

struct VesselModel {
  std::string name, kind = "card";
  VesselMesh mesh;
  std::vector<WallLayer> layers;
  WallOptions wall;
  TrackMaterial track;
  double thickness = 0.0;             // [m]
  bool adventitia = false;            // its outermost layer is one: tips can take a fold of it
  Vec3 cut_along = Vec3::UnitX();     // unit, direction of the cut at rest; of a vessel: where its angle is zero (end to side: at the heel)
  bool lumen = false;                 // two vessels in a double clamp
  DoubleClamp clamp;                  // of these, as first made
  double closed_gap = 0.0;            // [m], where it can be slid to
  std::vector<double> turns = {0.0, std::numbers::pi};  // [rad], from there, to which it is turned one after the other and round again: over and back
  TubeShape shape;                    // of each stump
  double radius = 0.0;                // [m], outer, as first made
  Circulation circulation;            // that the clamps keep out
  double slack = 0.0;                 // [Pa], transmural, as long as they do: below zero the stumps lie flat
};

}  // namespace filum
