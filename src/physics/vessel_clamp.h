#pragma once
// The double clamp (approximator): two jaws on one bar hold a stump each, cut edges facing. The jaws slide along the bar; the whole is
// turned over about the bar to show the back wall. Places are functions of three numbers, so that a scene can keep them in its state
// and move them at its own pace. Test: vessel_clamp_test.

#include <algorithm>
#include <array>
#include <cmath>

#include "physics/vessel_mesh.h"

namespace filum {

struct DoubleClamp {
  Pose X_WB;             // bar: z along the vessel, origin midway between the cut edges, y up
  double gap = 0.2e-3;   // [m], between the cut edges as long as they are free
  double turn = 0.0;     // [rad], about z: pi shows the back wall
};

/// Where the frames of both stumps are (origin in the held end, z towards the cut edge), for stumps of this length [m].
inline std::array<Pose, 2> stump_poses(const DoubleClamp& c, double length) {
  const Quat turned(Eigen::AngleAxisd(c.turn, Vec3::UnitZ()));
  const double reach = length + 0.5 * c.gap;
  const Pose bar = c.X_WB * Pose{Vec3::Zero(), turned};
  return {bar * Pose{Vec3(0, 0, -reach), Quat::Identity()}, bar * Pose{Vec3(0, 0, reach), Quat(0, 1, 0, 0)}};
}

/// Both stumps of this shape; parts 0 and 1. The wall's clamps are then placed at stump_poses(now) * stump_poses(first)^-1.
inline VesselMesh make_stumps(const TubeShape& shape, const DoubleClamp& first) {
  VesselMesh mesh;
  const VesselMesh stump = make_tube(shape);
  for (const Pose& X : stump_poses(first, shape.stretch * shape.length)) append(mesh, stump, X);
  return mesh;
}

/// How the held ends have moved since the mesh was made: what VesselWall::place_clamp() is to be given.
inline std::array<Pose, 2> clamp_motion(const DoubleClamp& first, const DoubleClamp& now, double length) {
  const auto a = stump_poses(first, length), b = stump_poses(now, length);
  return {b[0] * a[0].inverse(), b[1] * a[1].inverse()};
}

/// One step towards what is asked, no faster than these speeds [m/s], [rad/s].
inline DoubleClamp approach(const DoubleClamp& now, double gap, double turn, double dt, double slide_speed, double turn_speed) noexcept {
  DoubleClamp next = now;
  next.gap += std::clamp(gap - now.gap, -slide_speed * dt, slide_speed * dt);
  next.turn += std::clamp(turn - now.turn, -turn_speed * dt, turn_speed * dt);
  return next;
}

}  // namespace filum
