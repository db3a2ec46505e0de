#pragma once
// A brain spatula: a rigid open surface of triangles, flat or bent beforehand, tapered to its tip. Frame T as of every tool:
// origin in the middle of the tip's edge, +z along the blade towards the handle, x across, y out of the flat.
// Widths of 2 to 25 mm (reference: clinical blades). The surface has no thickness (Hansen et al. 2004, section 3).

#include <string>
#include <vector>

#include "base/tet_mesh.h"

namespace filum {

struct BladeBend {
  double at = 0.0;      // [m], distance from the tip along the blade
  double angle = 0.0;   // [rad], by which everything beyond turns about x
  double length = 5e-3; // [m], over which it turns
};

struct BladeShape {
  std::string name;
  double width = 10e-3;      // [m]
  double tip_width = 8e-3;   // [m]
  double taper = 15e-3;      // [m], length over which tip_width widens to width
  double length = 80e-3;     // [m]
  double grip = 100e-3;      // [m], tip to the point where the hand holds it
  std::vector<BladeBend> bends;
};

/// Throws InputError unless 2 mm <= widths <= 25 mm and the lengths fit together.
void check_blade(const BladeShape& shape, const std::string& file);

/// Triangles with what queries need; a surface of any shape.
struct RigidSurface {
  Points vertices;                              // [m], 3 x n, frame T
  std::vector<Triangle> triangles;
  std::vector<std::array<int, 3>> neighbours;   // triangle across the side opposite to each corner, -1 border
  std::vector<char> on_border;                  // of each vertex
  std::vector<Vec3> normals;                    // unit, of each triangle
  std::vector<Vec3> centres;                    // [m], of balls about the triangles
  std::vector<double> radii;                    // [m]
  static constexpr int kBlock = 8;
  std::vector<Vec3> block_centres;              // [m], of balls about kBlock triangles after one another
  std::vector<double> block_radii;              // [m]
  Vec3 low = Vec3::Zero(), high = Vec3::Zero(); // [m], box around it
};

RigidSurface rigid_surface(Points vertices, std::vector<Triangle> triangles);
/// The blade as along x across cells of two triangles.
RigidSurface blade_surface(const BladeShape& shape, int along, int across);

/// Where a point lies beside a surface.
struct SurfacePoint {
  int triangle = -1;
  Vec3 point = Vec3::Zero();   // [m], of the surface, nearest
  Vec3 normal = Vec3::UnitY(); // unit, of that triangle
  double gap = 0.0;            // [m], signed distance from the triangle's plane
  double beyond = 0.0;         // [m], distance past the border, measured in the plane; 0 over the surface
};

/// Nearest point of the surface, by walking from triangle `hint` to its neighbours while they are nearer; from every triangle
/// if hint is -1.
SurfacePoint nearest_point(const RigidSurface& s, const Vec3& q, int hint = -1) noexcept;

}  // namespace filum
