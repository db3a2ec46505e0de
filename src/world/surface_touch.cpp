#include "world/surface_touch.h"

#include <algorithm>
#include <cmath>

namespace filum {
namespace {

constexpr double kShallow = 50e-6;   // [m], half a wall: from deeper within a touch stays where it went in
constexpr double kLightest = 5e-6;   // [N], half of what the wall's step leaves unbalanced
constexpr double kJustAbove = 1e-6;  // [m], from where one looks
constexpr double kAlong = 0.1e-3;    // [m], by which a place goes along in a step at most
constexpr double kFacing = 0.3;      // [1], cosine: of sides that look the same way
constexpr double kAbove = 1e-3;      // [m], how far above a strand its place is looked for
constexpr double kCloseBy = 0.15;    // [1], of that, where it mostly is: the search costs as much as the box it looks in

/// A strand that stands above the plane of its place may have slid into tissue that rises there: it is out only if one sees it from the place.
void look_back(const VesselWall& wall, const WallState& w, const SurfaceTouch& touch, const TouchLaw& law, const Vec3& x, TouchFooting& f) noexcept {
  const WallCrossing c = meet_surface(wall, w, wall.on_triangle(w, touch.at) + (law.radius + kJustAbove) * touch.normal, x);
  if (!c.found) return;
  f.off = false;
  f.slides = true;
  f.near = c;
  f.normal = c.normal;
  f.depth = law.radius + (wall.on_triangle(w, c.point) - x).dot(c.normal);
}

}  // namespace

RodTether hold_touch(const VesselWall& wall, const WallState& w, const SurfaceTouch& touch, const TouchLaw& law, const Vec3& x) noexcept {
  RodTether t;
  t.arc = touch.arc;
  t.anchor = wall.on_triangle(w, touch.at) + law.radius * touch.normal;
  const double depth = (t.anchor - x).dot(touch.normal), share = depth > kDeepest ? kDeepest / depth : 1.0;
  t.stiffness = share * law.stiffness * touch.normal * touch.normal.transpose();
  t.along = touch.normal.unitOrthogonal();
  t.across = touch.normal.cross(t.along);
  t.stick = law.stiffness;
  t.limit = law.friction * touch.load;
  return t;
}

TouchFooting find_footing(const VesselWall& wall, const WallState& w, const SurfaceTouch& touch, const RodTether& t, const TouchLaw& law, const Vec3& x) noexcept {
  TouchFooting f;
  const double height = (x - wall.on_triangle(w, touch.at)).dot(touch.normal) - law.radius;
  const Vec3 rub = t.force - t.force.dot(touch.normal) * touch.normal, q = x + rub / law.stiffness;  // the bristle stays bent by what friction bears: what sticks does not creep
  f.near = wall.nearest(w, q, kAlong + law.radius);
  f.normal = f.near.away;
  f.deep = is_deep(wall, w, touch, law, x);
  const bool faces = f.near.found && f.normal.dot(touch.normal) > kFacing;
  const bool round_a_rim = !f.near.found || (!faces && f.near.fraction > law.radius);  // beside its place, and outside
  f.slides = faces && !f.deep;
  f.off = height >= 0.0 ? !(f.slides && f.near.fraction < law.radius) : round_a_rim && !f.slides && !f.deep;
  f.depth = f.slides ? law.radius - f.near.fraction : -height;
  if (f.off) look_back(wall, w, touch, law, x, f);
  return f;
}

double sinks_past(const VesselWall& wall, const WallState& w, const SurfaceTouch& touch, const Vec3& before, const Vec3& now) noexcept {
  const bool through = (wall.on_triangle(w, touch.at) - now).dot(touch.normal) > kThrough;
  return through ? std::max(0.0, (before - now).dot(touch.normal)) : 0.0;
}

bool stay_above(const VesselWall& wall, const WallState& w, SurfaceTouch& touch, const Vec3& x) noexcept {
  const Vec3 high = x + kAbove * touch.normal;
  for (const double until : {kCloseBy, 1.0}) {
    for (WallCrossing c = wall.crossing(w, x, high, 0.0, until); c.found; c = wall.crossing(w, x, high, c.fraction + 1e-9, until)) {
      if (c.normal.dot(touch.normal) <= 0.0) continue;
      touch.at = c.point;
      return true;
    }
  }
  return false;
}

void turn_touch(const VesselWall& wall, const WallState& w, SurfaceTouch& touch) noexcept {
  const VesselWall::SideNormals side = wall.side_normals(w, touch.at);
  touch.normal = (Quat::FromTwoVectors(side.before, side.now) * touch.normal).normalized();
}

bool is_deep(const VesselWall& wall, const WallState& w, const SurfaceTouch& touch, const TouchLaw& law, const Vec3& x) noexcept {
  return (x - wall.on_triangle(w, touch.at)).dot(touch.normal) - law.radius <= -kShallow;
}

void lean_touch(VesselWall& wall, const WallState& w, const SurfaceTouch& touch, const RodTether& t, const TouchLaw& law) noexcept {
  if (touch.load < kLightest) {
    wall.add_load(w, touch.at, -t.force);
    return;
  }
  WallSlip push;
  push.along = -touch.normal;
  push.force = touch.load;
  push.stick = law.stiffness;
  push.high = 2.0 * touch.load;
  wall.add_load(w, touch.at, Vec3::Zero(), Mat3::Zero(), push);
  if (t.limit <= 0.0) return;
  RodTether rub = t;
  rub.stiffness.setZero();
  rub.force -= t.force.dot(touch.normal) * touch.normal;
  load_wall(wall, w, touch.at, rub, wall.options().dt);
}

void slide_touch(SurfaceTouch& touch, const TouchFooting& footing) noexcept {
  if (!footing.slides) return;
  touch.at = footing.near.point;
  touch.normal = footing.normal;
}

WallCrossing meet_surface(const VesselWall& wall, const WallState& w, const Vec3& before, const Vec3& now) noexcept {
  WallCrossing c = wall.crossing(w, before, now);
  c.found = c.found && (now - before).dot(c.normal) < 0.0;
  return c;
}

}  // namespace filum
