#pragma once
// Tissue of a scene: what changes from step to step.

#include <array>
#include <cstdint>

#include "physics/track_state.h"
#include "physics/vessel_flow.h"
#include "physics/wall_grip.h"

namespace filum {

/// A point of the thread or of the needle that pushes against the surface. Part of the state.
struct SurfaceTouch {
  double arc = 0.0;            // [m], of the thread, or of the needle from its swage
  WallPoint at;                // of the surface
  Vec3 normal = Vec3::UnitZ();  // outward, when last looked at
  double load = 0.0;           // [N], normal, in the last step
  Vec3 push = Vec3::Zero();    // [N], of the wall on a needle, in the last step
  double firm = 0.0;           // [N/m], by which that changes as a needle in hand moves
};
inline constexpr int kMostTouches = 256;

struct TouchState {
  std::int32_t n = 0;
  std::array<SurfaceTouch, kMostTouches> touches;
};

/// Thread that lay deep in the tissue when it was last looked for (stray_thread.h). Part of the state.
struct StrayPlace {
  double strand = 0.0;         // [m], behind the swage
  Vec3 x = Vec3::Zero();       // [m]
};
inline constexpr int kMostStrays = 16;
struct StrayState {
  std::int32_t unseen = 0;     // steps since
  std::int32_t n = 0;
  std::array<StrayPlace, kMostStrays> places;
};

/// The double clamp as the trainee's buttons have left it. Part of the state.
struct ClampState {
  double gap = 0.0;            // [m], between the cut edges as long as they are free
  double turn = 0.0;           // [rad], about the bar
  std::int32_t over = 0;       // which of its turns it is at, or on the way to: 0 as first made
  std::int32_t closing = 0;    // which way it slid last
  std::uint32_t down = 0;      // buttons that are pressed
};

inline constexpr int kMostEdgeNodes = 64;

/// Blood, from the moment on that the trainee takes a clamp off. Part of the state.
struct BloodState {
  std::array<std::int32_t, 2> off{};  // the upstream, the downstream clamp
  std::int32_t wrong_order = 0;       // the downstream one came off first
  std::int32_t known = 0, next = 0;   // nodes of the cut edge whose gap has been measured; which is next
  std::array<EdgeGap, kMostEdgeNodes> gaps;
  double lost = 0.0;                  // [m3]
  Milking milking;
  bool flowing() const noexcept { return off[0] != 0 || off[1] != 0; }
};

struct VesselState {
  WallState wall;
  TrackState tracks;
  TouchState touches, wire;            // of the thread, of the needle
  StrayState strays;
  ClampState clamp;
  BloodState blood;
  std::array<WallGrip, 3> grips;       // of each tool
  std::array<double, 2> pressure{};  // [Pa], transmural, of each stump
};

}  // namespace filum
