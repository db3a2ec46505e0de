#pragma once
// A block of brain below a craniotomy, made from a few numbers: gyri and sulci on its surface, on request a fissure that opens
// from the top, whose lips are separate, bridging veins between cortex and dura. Nothing has to be downloaded. It has the
// measures of the region, not the shape of any person's.

#include <vector>

#include "base/tet_mesh.h"

namespace filum {

struct CortexShape {
  Vec3 size = Vec3(0.08, 0.06, 0.04);  // [m], x along the fissure, y across, z deep; top at z = 0
  std::array<int, 3> cells{20, 16, 8};
  double gyrus = 12e-3;      // [m], width
  double sulcus = 1.5e-3;    // [m], depth of the furrows between gyri
  double fissure_depth = 0.0;   // [m], 0: none; runs along x through the middle
  double fissure_gap = 1e-3;    // [m], distance of the lips at the top; at the bottom they meet
  double fissure_wave = 2e-3;   // [m], by which its course sways
  bool open_side = false;       // the side of least y is free cortex that faces bone, y = 0 there: a lobe seen from its base
  double lean = 0.0;            // [m], by which that side hangs over at the top
  double grey = 3e-3;        // [m], thickness of the cortex: region 0; white matter below: region 1
};

struct Cortex {
  TetMesh mesh;
  std::vector<int> held;             // nodes at the border of the block
  std::vector<Triangle> surface;     // what a blade can touch: cortex and the walls of the fissure, outward
  std::vector<int> surface_nodes;    // of them, ascending
  double bone_y = 0.0;               // [m], bone fills what lies below this y, for the eye; 0: none
};

/// Throws InputError (naming `file`) for sizes that make no block.
Cortex make_cortex(const CortexShape& shape, const std::string& file);
/// The same from a mesh that was made elsewhere: held below `held_below` and, seen from above, further than `held_beyond` from the
/// origin [m].
Cortex cortex_from_mesh(TetMesh mesh, double held_below, double held_beyond);

}  // namespace filum
