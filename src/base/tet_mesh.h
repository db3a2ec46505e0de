#pragma once
// Tetrahedral meshes: nodes, elements with a region each, outward surface, quality, and the block that most tests use.

#include <array>
#include <string>
#include <vector>

#include "base/pose.h"

namespace filum {

using Triangle = std::array<int, 3>;
using Tetrahedron = std::array<int, 4>;  // (p1-p0) x (p2-p0) . (p3-p0) > 0

struct TetMesh {
  Points nodes;                   // [m], 3 x n, at rest
  std::vector<Tetrahedron> tets;
  std::vector<int> region;        // of each element; empty: all 0
  int n_nodes() const { return static_cast<int>(nodes.cols()); }
  int n_tets() const { return static_cast<int>(tets.size()); }
  int region_of(int e) const { return region.empty() ? 0 : region[static_cast<std::size_t>(e)]; }
};

/// Signed volume. [m3]
double tet_volume(const TetMesh& mesh, int e) noexcept;

/// Block from `low` to `high` [m] of nx x ny x nz cells, each cut into the six tetrahedra about one diagonal (Kuhn); node
/// (i, j, k) has the number i + (nx+1) (j + (ny+1) k).
TetMesh box_mesh(const Vec3& low, const Vec3& high, int nx, int ny, int nz);

/// Faces that belong to one element only, turned outward, in the order of the elements.
std::vector<Triangle> surface_triangles(const TetMesh& mesh);

struct MeshQuality {
  double smallest_volume = 0.0;  // [m3]
  double worst_shape = 1.0;      // smallest radius ratio 3 r_in / r_circum: 1 regular, 0 flat
  double mean_shape = 1.0;
  double shortest_edge = 0.0, longest_edge = 0.0;  // [m]
};
MeshQuality mesh_quality(const TetMesh& mesh);

/// Throws InputError naming the element or node: node numbers out of range, repeated, coordinates that are not finite,
/// elements inverted or without volume, nodes of no element.
void check_mesh(const TetMesh& mesh, const std::string& file);

/// Reads or writes a mesh of format filum-mesh/1: a line with the counts, then nodes [m], then elements with their region.
TetMesh load_mesh(const std::string& path);
void save_mesh(const TetMesh& mesh, const std::string& path);

}  // namespace filum
