#pragma once
// Hexahedra of a vessel wall: tubes cut at one end (square or bevelled), tubes with an opening in their side, flaps of a flat card, and several together. An element carries
// the corners it would have without stress beside its nodes, so that rings sprung shut (opening angle) and stretched tubes
// are meshes like any other (Holzapfel, Gasser & Ogden 2000, sec. 3.1: r(R), k = 2 pi / (2 pi - alpha)).
// Local coordinates of an element: xi around (or along the edge of a card), eta along (towards the cut edge), zeta outward, each
// in [-1, 1]; corner a has the sign of bit 0 of a in xi, of bit 1 in eta, of bit 2 in zeta. Test: vessel_mesh_test.

#include <array>
#include <vector>

#include "base/pose.h"
#include "base/tet_mesh.h"

namespace filum {

enum class WallSurface { inner, outer, edge, end };  // edge: of the cut or opening; end: the other borders

using Corners = Eigen::Matrix<double, 3, 8>;

/// Corners of each side of an element, turning about its outward normal: at xi = 1, xi = -1, eta = 1 and so on.
inline constexpr std::array<std::array<int, 4>, 6> kElementSides = {{{1, 3, 7, 5}, {0, 4, 6, 2}, {2, 6, 7, 3}, {0, 1, 5, 4}, {4, 5, 7, 6}, {0, 2, 3, 1}}};

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
  std::vector<std::vector<double>> edge_share;  // where on the ring each of them is: share of its length as first made, from its first node
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
  double bevel = 0.0;              // [rad], of the cut, from square, as first made: the lip at angle zero is the longest, and `length` is that of the axis
};

/// Axis along z from the clamp at z = 0 to the cut edge; held: the nodes at z = 0.
VesselMesh make_tube(const TubeShape& shape);

/// An ellipse out of the side of a tube, half way along it, as first made.
struct SideOpening {
  double length = 1.4e-3, width = 0.7e-3;  // [m], axes of the ellipse: along the tube, and around it on the middle of the wall
  int across = 6, along = 8;               // elements of the tube's grid whose place it takes; across even
};

/// Both ends are held (shape.grading and shape.bevel do not count). The ellipse's middle lies at angle zero; its ring begins at its end of greater z.
/// The border of the grid's gap is spread over the ellipse, more densely at its ends along the tube; between it and the tube's ends every point is the mean of
/// its four neighbours on the grid (discrete harmonic map), so that three elements meet in 180 degrees at each of the gap's corners. Throws std::invalid_argument if it does not fit.
VesselMesh make_opened_tube(const TubeShape& shape, const SideOpening& opening);

/// Least over the corners of an element of det(dx/dxi) by the product of its three sides there: 1 a brick, 0 flat, negative inside out (scaled
/// Jacobian: Knupp, SIAM J. Sci. Comput. 23:193, 2001).
double scaled_jacobian(const Corners& corners) noexcept;

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
