#pragma once
// A plane cut through tetrahedra: what the cross-section view shows. Each corner of the cut lies on an edge of the mesh, so it
// moves with the tissue; each triangle lies in one element and has its stress. Test: brain_section_test.

#include <array>
#include <vector>

#include "base/tet_mesh.h"

namespace filum {

struct BrainSection {
  struct Corner {
    int a = 0, b = 0;   // nodes of the edge
    double t = 0.0;     // share of b
  };
  std::vector<Corner> corners;
  std::vector<std::array<int, 3>> triangles;
  std::vector<int> element;  // of each triangle
};

/// The mesh cut at x [m]; a plane through nodes is moved aside by a tenth of a millimetre.
BrainSection cut_mesh(const TetMesh& mesh, double x);

inline Vec3 corner_place(const BrainSection::Corner& c, const Points& x) { return (1.0 - c.t) * x.col(c.a) + c.t * x.col(c.b); }

/// sqrt(3/2 s:s), s the deviator. [Pa]
double von_mises(const Mat3& stress) noexcept;

}  // namespace filum
