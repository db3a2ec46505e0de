#pragma once
// Slices of a tube under axial stretch and pressure, solved with the trainer's wall elements: what the vessel problems share.

#include "physics/vessel_wall_element.h"
#include "physics/vessel_wall_static.h"

namespace filum {

/// A slice of a long tube: one element along, both ends kept in their planes.
struct TubeSlice {
  TubeShape shape;
  std::vector<WallLayer> layers;
  int around = 48, through = 9;
};

struct SliceState {
  bool converged = false;
  double inner = 0.0, outer = 0.0;   // [m], radii, mean of the nodes
  double axial_force = 0.0;          // [N], of the wall at its ends
  double lumen = 0.0;                // [m2], volume over length
  VesselMesh mesh;
  Points x;
};

/// Equilibrium at each pressure [Pa] in turn, each from the one before.
std::vector<SliceState> inflate(const TubeSlice& slice, const std::vector<double>& pressures);

/// Rabbit carotid of Holzapfel, Gasser & Ogden 2000, media and adventitia; opening angle 0 or 160 degrees.
TubeSlice rabbit_carotid(bool opened);

}  // namespace filum
