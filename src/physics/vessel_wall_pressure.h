#pragma once
// Pressure on the inner faces of a tube and the volume inside: f_a = p int N_a (x_,xi x x_,eta) dA over bilinear faces, exact by 2 x 2
// Gauss points. The pressure follows the surface as it deforms. Volume: 1/3 of the flux of x - q through the inner faces and
// through flat fans that close both ends (q any point, here the middle of the faces), by the divergence theorem.
// Test: vessel_wall_pressure_test.

#include <span>

#include "physics/vessel_mesh.h"

namespace filum {

/// Adds the forces [N] of `pressure` [Pa] of each part. Allocates nothing.
void add_pressure_forces(const VesselMesh& mesh, std::span<const double> pressure, const Points& x, Points& force) noexcept;

/// -d(force)/dx of one face [N/m] under `pressure`: 12 x 12, corner by corner of the face; not symmetric at the rims.
Eigen::Matrix<double, 12, 12> pressure_stiffness(const VesselMesh& mesh, const WallFace& face, double pressure, const Points& x) noexcept;

/// Lumen of a part [m3], from its clamp to the cut edge.
double lumen_volume(const VesselMesh& mesh, int part, const Points& x);

}  // namespace filum
