#pragma once
// The double clamp (approximator): two jaws on one bar hold a stump each, cut edges facing. The jaws slide along the bar; the whole is
// turned over about the bar to show the back wall. Places are functions of three numbers, so that a scene can keep them in its state
// and move them at its own pace.
// End to side, the bar holds both ends of a vessel with an opening in its side, and an arm holds a stump that leans over it, its end bevelled parallel
// to the vessel; the stump slides towards the opening, the whole is turned about the vessel. Test: vessel_clamp_test.

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "physics/vessel_mesh.h"

namespace filum {

struct SideHold {
  double lean = 0.785;   // [rad], between the stump and the vessel; its body lies towards +z of the bar, its long lip (toe) towards -z
  double reach = 2e-3;   // [m], from the middle of the opening to the vessel's held ends
  double radius = 0.5e-3;  // [m], outer, of the vessel as first made
};

struct DoubleClamp {
  Pose X_WB;             // bar: z along the vessel, origin on its axis midway between the cut edges (in the middle of the opening), y up (out of it)
  double gap = 0.2e-3;   // [m], between the cut edges as long as they are free
  double turn = 0.0;     // [rad], about z: pi shows the back wall
  std::optional<SideHold> side;  // end to side
};

/// Where the frames of both stumps are (origin in the held end, z towards the cut edge), for stumps of this length [m].
inline std::array<Pose, 2> stump_poses(const DoubleClamp& c, double length) {
  const Quat turned(Eigen::AngleAxisd(c.turn, Vec3::UnitZ()));
  const double reach = length + 0.5 * c.gap;
  const Pose bar = c.X_WB * Pose{Vec3::Zero(), turned};
  if (c.side) {
    const double s = std::sin(c.side->lean), k = std::cos(c.side->lean);
    Mat3 leaning;  // y along the cut towards the long lip
    leaning << -1, 0, 0, 0, k, -s, 0, -s, -k;
    return {bar * Pose{Vec3(0, 0, -c.side->reach), Quat::Identity()}, bar * Pose{Vec3(0, c.side->radius + c.gap + length * s, length * k), Quat(leaning)}};
  }
  return {bar * Pose{Vec3(0, 0, -reach), Quat::Identity()}, bar * Pose{Vec3(0, 0, reach), Quat(0, 1, 0, 0)}};
}

/// Both stumps of this shape; parts 0 and 1. The wall's clamps are then placed at stump_poses(now) * stump_poses(first)^-1.
inline VesselMesh make_stumps(const TubeShape& shape, const DoubleClamp& first) {
  VesselMesh mesh;
  const VesselMesh stump = make_tube(shape);
  for (const Pose& X : stump_poses(first, shape.stretch * shape.length)) append(mesh, stump, X);
  return mesh;
}

/// A vessel with an opening in its side, part 0, and a stump with its end bevelled to meet it, part 1. The vessel's length is set by first.side.
inline VesselMesh make_end_to_side(TubeShape vessel, const SideOpening& opening, TubeShape stump, const DoubleClamp& first) {
  const Pose quarter{Vec3::Zero(), Quat(Eigen::AngleAxisd(0.5 * std::numbers::pi, Vec3::UnitZ()))};  // opening and long lip from x to y
  vessel.length = 2.0 * first.side->reach / vessel.stretch;
  stump.bevel = 0.5 * std::numbers::pi - first.side->lean;
  const auto pose = stump_poses(first, stump.stretch * stump.length);
  VesselMesh mesh;
  append(mesh, make_opened_tube(vessel, opening), pose[0] * quarter);
  append(mesh, make_tube(stump), pose[1] * quarter);
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
