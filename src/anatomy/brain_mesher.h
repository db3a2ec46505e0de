#pragma once
// The part of a brain that is seen through a craniotomy, as tetrahedra: a cylinder about the line from the window to the middle
// of the brain, cut off at a depth, elements growing with depth. The surface alone is meshed to; an element is white matter if
// most of its middle is (a surface between grey and white, folded as it is, doubles the work and the elements). Meshed by CGAL (Delaunay refinement; Jamin, Alliez, Yvinec &
// Boissonnat, ACM Trans. Math. Softw. 41:23, 2015). Frame of the scene: origin on the cortex in the middle of the window, z
// outward, y towards the front of the head as far as it goes. Test: brain_mesher_test.

#include "anatomy/head_scan.h"
#include "base/tet_mesh.h"

namespace filum {

struct Window {
  Vec3 at = Vec3::Zero();  // [m], scanner; the nearest way from the brain's middle through it is taken
  double radius = 35e-3;   // [m]
  double depth = 35e-3;    // [m]
  double fine = 3e-3;      // [m], size of elements at the cortex
  double coarse = 7e-3;    // [m], and at the depth
};

struct BrainRegion {
  TetMesh mesh;                       // [m], scene; region 0 grey, 1 white
  Mat3 axes = Mat3::Identity();       // scene -> scanner
  Vec3 origin = Vec3::Zero();         // [m], of the scene, scanner
  double grey = 0.0, white = 0.0;     // [m3]
  int dropped = 0;                    // elements of pieces that hang on nothing
};

/// Throws InputError (naming `file`) for windows that show no brain.
BrainRegion mesh_region(const BrainScan& scan, const Window& window, const std::string& file);

}  // namespace filum
