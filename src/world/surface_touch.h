#pragma once
// A place where a strand, thread or needle, pushes against the surface of the tissue: a spring along the outward normal with Coulomb friction in the
// surface, staggered with the tissue's step, which gets the opposite load.
//
// The place is remembered, so that a strand cannot come out on the far side, however fast it goes. It follows what slides only: it is where x + f/k is nearest to the
// surface, f the friction borne by bristles of stiffness k (return mapping), so that what sticks does not creep. A touch ends when the strand is above its place and in sight of it.
// Tests: surface_touch_test, vessel_contact_test, wire_contact_test.

#include "physics/needle_track.h"
#include "world/vessel_state.h"

namespace filum {

struct TouchLaw {
  double stiffness = 200.0;    // [N/m]
  double friction = 0.2;       // [-]
  double radius = 0.0;         // [m], of the strand
};

/// What the touch holds a strand by whose axis is at x [m], frame W, in the coming step.
RodTether hold_touch(const VesselWall& wall, const WallState& w, const SurfaceTouch& touch, const TouchLaw& law, const Vec3& x) noexcept;
/// Where a touch stands after the strand has moved to x.
struct TouchFooting {
  double depth = 0.0;          // [m], of the strand's skin below the surface
  bool off = false;            // it is free again, and the touch has ended
  bool slides = false;         // to `near`
  bool deep = false;           // is_deep()
  WallCrossing near;
  Vec3 normal;                 // there: `away`, the gradient of the distance
};
TouchFooting find_footing(const VesselWall& wall, const WallState& w, const SurfaceTouch& touch, const RodTether& t, const TouchLaw& law, const Vec3& x) noexcept;
/// What a strand that the wall can push aside does to it in its coming step. A thread is no post: a wall that comes on at 5 mm/s would be dented by one of 200 N/m,
/// where the thread weighs 0.1 ug and moves off. It bears at most twice what it bore, in the next step as much again; what is light just weighs.
void lean_touch(VesselWall& wall, const WallState& w, const SurfaceTouch& touch, const RodTether& t, const TouchLaw& law) noexcept;
/// Has the strand at x gone so far past its place that the surface nearest to it may be another one? It is drawn back the way it came.
bool is_deep(const VesselWall& wall, const WallState& w, const SurfaceTouch& touch, const TouchLaw& law, const Vec3& x) noexcept;
/// [m], by which a strand that is more than kThrough below its place has gone on into the tissue on its way from `before` to `now`; 0: it has not, or is not so deep.
double sinks_past(const VesselWall& wall, const WallState& w, const SurfaceTouch& touch, const Vec3& before, const Vec3& now) noexcept;
/// The place of one that cannot slide goes along over it: where its way out, along the normal, leaves the tissue on the side that it came from. False: nowhere
/// within a millimetre, so that it is not behind anything.
bool stay_above(const VesselWall& wall, const WallState& w, SurfaceTouch& touch, const Vec3& x) noexcept;
/// That way turns with the wall, after the wall's step.
void turn_touch(const VesselWall& wall, const WallState& w, SurfaceTouch& touch) noexcept;
/// The place goes along with what slid.
void slide_touch(SurfaceTouch& touch, const TouchFooting& footing) noexcept;
/// Where a sample that goes from `before` to `now` [m] comes upon the surface from outside; not found: nowhere.
WallCrossing meet_surface(const VesselWall& wall, const WallState& w, const Vec3& before, const Vec3& now) noexcept;

inline constexpr double kDeepest = 30e-6;      // [m], overlap from which the force grows no more: what has gone deeper is drawn back by a softer spring, but all the way
inline constexpr double kThrough = 50e-6;      // [m], half a wall: as far as a strand goes in a step at 25 mm/s
inline constexpr double kOneTouch = 35e-6;     // [m], of thread that one touch stands for, either way
inline constexpr double kTrackReach = 0.3e-3;  // [m], of a strand on either side of a track that is left alone

}  // namespace filum
