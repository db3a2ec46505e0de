#include "physics/wall_grasp.h"

#include <algorithm>
#include <cmath>

namespace filum {
namespace {

constexpr double kStiffness = 500.0;      // [N/m], of a bristle: 0.04 mm at the most that is borne
constexpr double kFriction = 0.3;         // [-] [P], fine serrations on wet tissue
constexpr double kWallBears = 60e-3;      // [N] [P], the wall through its thickness
constexpr double kOutsideBears = 25e-3;   // [N] [P], a fold of adventitia
constexpr double kMostBetween = 2.5;      // thicknesses, of a wall
constexpr double kWidestFold = 0.15e-3;   // [m] [P], of adventitia, between the tips
constexpr double kTouch = 5e-6;           // [m], of a tip from what it touches
constexpr double kFacing = 0.7071;        // [-] [P], cosine: 45 degrees
constexpr double kSqueezed = 0.8;         // of what lies between
constexpr double kLetGo = 1.15;           // of the opening at which it was taken
constexpr double kOff = 50e-6;            // [m], beyond the pad
constexpr std::array<double, kMostGripPlaces> kPlaces = {0.05e-3, 0.25e-3, 0.45e-3};  // [m], along the pads

/// Face of the pad at +x (side 0) or -x, `z` from the tips, with the jaws opened by `angle`, tool frame.
Vec3 pad_face(const InstrumentParameters& p, double angle, int side, double z) noexcept {
  const double behind = p.jaw_length - z, half = 0.5 * angle;
  return {(side == 0 ? 1.0 : -1.0) * behind * std::sin(half), 0.0, p.jaw_length - behind * std::cos(half)};
}

double opening(const InstrumentParameters& p, double gap, double z) noexcept { return 2.0 * std::asin(std::min(1.0, 0.5 * gap / (p.jaw_length - z))); }

bool face_each_other(const WallCrossing& a, const WallCrossing& b, const Vec3& way) noexcept {
  return -a.normal.dot(way) >= kFacing && b.normal.dot(way) >= kFacing;
}

/// Adds a place that the jaws hold between points `between` [m] apart.
void add(const InstrumentParameters& p, const WallGripPlace& place, double between, WallGrip& grip) noexcept {
  grip.places[static_cast<std::size_t>(grip.n++)] = place;
  grip.stop = std::max(grip.stop, opening(p, kSqueezed * between, place.z));
  grip.leave = std::max(grip.leave, kLetGo * opening(p, between, place.z));
}

/// What the pads have between them at z, if they touch it on both sides.
void take_through(const VesselWall& wall, const WallState& w, const GrippingTool& tool, double thickness, double z, WallGrip& grip) noexcept {
  const InstrumentParameters& p = tool.parameters;
  const double radius = p.tip_radius + z / p.jaw_length * (p.base_radius - p.tip_radius);
  const Pose& X = tool.state.X_WT;
  const Vec3 face[2] = {pad_face(p, tool.state.angle, 0, z), pad_face(p, tool.state.angle, 1, z)};
  const Vec3 from = X * Vec3(face[0] + radius * Vec3::UnitX()), to = X * Vec3(face[1] - radius * Vec3::UnitX());  // the jaws' middles: faces may have met
  const WallCrossing a = wall.crossing(w, from, to), b = wall.crossing(w, to, from);
  if (!a.found || !b.found || (a.surface == WallSurface::outer && b.surface == WallSurface::outer)) return;
  const Vec3 pa = wall.position(w, a.point), pb = wall.position(w, b.point), way = (to - from).normalized();
  const double between = (pb - pa).dot(way), gap = (face[0] - face[1]).norm();
  if (between <= 0.0 || between > kMostBetween * thickness || gap > between || !face_each_other(a, b, way)) return;
  const Pose X_TW = X.inverse();
  WallGripPlace place;
  place.z = z;
  place.at = {a.point, b.point};
  place.offset_T = {X_TW * pa - face[0], X_TW * pb - face[1]};
  add(p, place, between, grip);
}

/// A fold of what both tips touch from outside.
void take_fold(const VesselWall& wall, const WallState& w, const GrippingTool& tool, WallGrip& grip) noexcept {
  const InstrumentParameters& p = tool.parameters;
  const Pose& X = tool.state.X_WT;
  const Vec3 face[2] = {pad_face(p, tool.state.angle, 0, 0.0), pad_face(p, tool.state.angle, 1, 0.0)};
  const double gap = (face[0] - face[1]).norm();
  if (gap > kWidestFold) return;
  WallGripPlace place;
  for (std::size_t side = 0; side < 2; ++side) {
    const Vec3 middle = X * Vec3(face[side] + (side == 0 ? 1.0 : -1.0) * p.tip_radius * Vec3::UnitX());
    const WallCrossing near = wall.nearest(w, middle, p.tip_radius + kTouch);
    if (!near.found || near.surface != WallSurface::outer || near.fraction < 0.0) return;
    place.at[side] = near.point;
    place.offset_T[side] = X.inverse() * wall.position(w, near.point) - face[side];
  }
  add(p, place, gap, grip);
}

Vec3 pad_point_T(const GrippingTool& tool, const WallGripPlace& place, int side) noexcept {
  return pad_face(tool.parameters, tool.state.angle, side, place.z) + place.offset_T[static_cast<std::size_t>(side)];
}

bool on_pad(const GrippingTool& tool, const WallGripPlace& place) noexcept {
  for (int side = 0; side < 2; ++side) {
    const Vec3& slid = place.slid_T[static_cast<std::size_t>(side)];
    const double z = place.z + slid.z();
    if (std::abs(slid.y()) > tool.parameters.pads.half_width + kOff || z < -kOff || z > tool.parameters.pads.length + kOff) return false;
  }
  return true;
}

}  // namespace

double grip_limit(const WallGrip& grip, double grip_force) noexcept {
  return std::min(kFriction * grip_force, grip.through != 0 ? kWallBears : kOutsideBears);
}

bool take_wall(const VesselWall& wall, const WallState& w, const GrippingTool& tool, const GrippedWall& kind, WallGrip& grip) noexcept {
  grip = {};
  for (const double z : kPlaces)
    if (z <= tool.parameters.pads.length) take_through(wall, w, tool, kind.thickness, z, grip);
  grip.through = grip.n > 0 ? 1 : 0;
  if (grip.n == 0 && kind.adventitia) take_fold(wall, w, tool, grip);
  return grip.n > 0;
}

void pull_wall(VesselWall& wall, const WallState& w, const GrippingTool& tool, WallGrip& grip) noexcept {
  const double limit = grip_limit(grip, tool.state.grip_force) / std::max(1, grip.n);
  const Pose& X = tool.state.X_WT;
  int kept = 0;
  for (int k = 0; k < grip.n; ++k) {
    WallGripPlace place = grip.places[static_cast<std::size_t>(k)];
    Vec3 force[2];
    for (int side = 0; side < 2; ++side) {
      Vec3 stretch = X * pad_point_T(tool, place, side) - wall.position(w, place.at[static_cast<std::size_t>(side)]);
      const double excess = stretch.norm() - limit / kStiffness;
      if (excess > 0.0) {
        const Vec3 slid = excess * stretch.normalized(), slid_T = X.q.conjugate() * slid;
        place.offset_T[static_cast<std::size_t>(side)] -= slid_T;
        place.slid_T[static_cast<std::size_t>(side)] -= slid_T;
        stretch -= slid;
      }
      force[side] = kStiffness * stretch;
    }
    if (!on_pad(tool, place)) continue;
    for (int side = 0; side < 2; ++side) wall.add_load(w, place.at[static_cast<std::size_t>(side)], force[side], kStiffness);
    grip.places[static_cast<std::size_t>(kept++)] = place;
  }
  grip.n = kept;
}

void feel_wall(const VesselWall& wall, const WallState& w, const GrippingTool& tool, WallGrip& grip, Vec3& force, Vec3& torque) noexcept {
  const Pose& X = tool.state.X_WT;
  Vec3 sum = Vec3::Zero();
  for (int k = 0; k < grip.n; ++k) {
    const WallGripPlace& place = grip.places[static_cast<std::size_t>(k)];
    for (int side = 0; side < 2; ++side) {
      const Vec3 pad = X * pad_point_T(tool, place, side);
      const Vec3 f = kStiffness * (wall.position(w, place.at[static_cast<std::size_t>(side)]) - pad);
      sum += f;
      torque += (pad - X.p).cross(f);
    }
  }
  force += sum;
  grip.pull = sum.norm();
}

}  // namespace filum
