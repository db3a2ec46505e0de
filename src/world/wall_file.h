#pragma once
// Vessel presets, models/vessel/*.yaml of format filum-vessel/1: every number with its unit, uncertainty and source. A layer that is not linear may have
// `tone`: { shape: parabola or bell, active_stress, stretch_of_most_tone }. Unknown keys, missing sources and values out of range are refused with file,
// field and value. Test: wall_file_test.

#include <string>
#include <vector>

#include "physics/vessel_wall.h"

namespace filum {

struct VesselPreset {
  std::string title;
  bool tube = true;               // else a flat card: shape has no meaning then
  TubeShape shape;                // stress-free tube of one stump; its stretch is 1: cut vessels draw back; axial_stretch is what it had in the body
  double axial_stretch = 1.0;     // [-]
  double pressure = 0.0;          // [Pa], transmural, of the vessel in use
  std::vector<WallLayer> layers;  // inner first
  WallOptions wall;               // density and damping; the rest as by default
};

VesselPreset load_vessel(const std::string& path);

}  // namespace filum
