#pragma once
// A slice of a long tube under axial stretch and pressure, one element along, both ends kept in their planes: static equilibrium with the trainer's
// wall elements (vessel_wall_static.h). For validation and for inflation rigs. Test: tube_slice_test; `filum validate vessel-*`.

#include "physics/vessel_wall_element.h"
#include "physics/vessel_wall_static.h"
#include "physics/wall_softening.h"

namespace filum {

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

/// Pressure [Pa] that the slice bears with its inner face at each radius [m] in turn, every element softening by its own past; NaN where no equilibrium
/// was found.
std::vector<double> borne(const TubeSlice& slice, const WallSoftening& softening, const std::vector<double>& inner);

}  // namespace filum
