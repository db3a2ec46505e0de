#pragma once
// Hexahedra of a vessel wall: tubes cut open at one end, flaps of a flat card, and several of them together. An element carries
// the corners it would have without stress beside its nodes, so that rings sprung shut (opening angle) and stretched tubes
// are meshes like any other (Holzapfel, Gasser & Ogden 2000, sec. 3.1: r(R), k = 2 pi / (2 pi - alpha)).
// Local coordinates of an element: xi around (or along the edge of a card), eta along (towards the cut edge), zeta outward, each
// in [-1, 1]; corner a has the sign of bit 0 of a in xi, of bit 1 in eta, of bit 2 in zeta. Test: vessel_mesh_test.

#include <array>
#include <vector>

#include "base/pose.h"
#include "base/tet_mesh.h"

namespace filum {

enum class WallSurface { inner, outer, edge, end };  // edge: the cut edge (eta = 1); end: the other borders

using Corners = Eigen::Matrix<double, 3, 8>;

struct WallFace {
  int element = 0;
  WallSurface surface = WallSurface::inner;
  std::array<int, 4> corner;  // of the element, turning about the outward normal
};

struct VesselMesh {
  Points nodes;                               // [m], 3 x n, where they start; numbered part by part, slab by slab
  std::vector<std::array<int, 8>> elements;
  std::vector<Corners> stress_free;           // [m], of each element
  std::vector<std::array<double, 2>> span;    // of each element: what part of the wall's thickness it fills, 0 inner to 1 outer
  std::vector<int> part;                      // of each element
  std::vector<int> node_part;
  std::vector<int> slab;                      // of each node, ascending; elements join a slab and the next only
  std::vector<int> held;                      // nodes that a clamp or frame moves
  std::vector<WallFace> faces;                // the whole surface
  std::vector<std::vector<int>> edge_ring;    // of each part: nodes of the inner rim of its cut edge, in order
  std::vector<int> sectors;                   // of each part: alike, round closed rings; 0: none such
  int n_nodes() const { return static_cast<int>(nodes.cols()); }
  int n_elements() const { return static_cast<int>(elements.size()); }
};

struct TubeShape {
  double inner_radius = 0.35e-3;   // [m], of the stress-free (cut open) tube
  double thickness = 0.1e-3;       // [m], stress-free
  double length = 3e-3;            // [m], of the stress-free tube
  double opening_angle = 0.0;      // [rad]
  double stretch = 1.0;            // [-], axial, of the first shape
  double first_inner_radius = 0.0; // [m], of the first shape; 0: such that the middle of the wall keeps its length
  int around = 24, along = 15, through = 1;  // elements
  double edge_grading = 1.0;       // length of the elements at the clamp over those at the cut edge
};

/// Axis along z from the clamp at z = 0 to the cut edge; held: the nodes at z = 0.
VesselMesh make_tube(const TubeShape& shape);

struct CardShape {
  double width = 10e-3, depth = 5e-3;  // [m], x along the cut edge, y towards it
  double thickness = 0.15e-3;          // [m]
  int across = 20, deep = 10, through = 1;
};

/// Flap in the plane z = 0 (middle), centred in x, cut edge at y = 0, held along its other three borders. zeta is up.
VesselMesh make_card(const CardShape& shape);

/// Appends `more`, placed by X, as further parts.
void append(VesselMesh& mesh, const VesselMesh& more, const Pose& X);

/// Two triangles for each face, outward, in the order of the faces.
std::vector<Triangle> face_triangles(const VesselMesh& mesh);

}  // namespace filum
