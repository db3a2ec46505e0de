#pragma once
// The ways of needle and thread through tissue as they are between two steps (needle_track.h).

#include <array>
#include <cstdint>

#include "physics/wall_state.h"

namespace filum {

/// A material point that holds the strand.
struct TrackKnot {
  WallPoint at;
  double strand = 0.0;   // [m], what is in it: arc on the needle from the swage; negative: thread behind the swage
  double span = 0.0;     // [m], length of strand that it stands for
  double lateral = 0.0;  // [N], across the strand, in the last step
};

inline constexpr int kTrackKnots = 12;
inline constexpr int kMaxTracks = 40;

struct NeedleTrack {
  std::int32_t n = 0;
  std::int32_t out = 0;        // the point has come out
  std::int32_t ended = 0;      // 1 pulled out backwards, 2 torn out
  std::int32_t part = 0;
  std::array<TrackKnot, kTrackKnots> knots;
  WallPoint entry, exit;
  double entry_angle = 0.0, exit_angle = 0.0;   // [rad], against the surface
  double bite_entry = 0.0, bite_exit = 0.0;     // [m]
  double shallow = 1.0, deep = 0.0;             // depth_at of its knots, least and most
  double hole = 0.0;                            // [m], radius
  double torn = 0.0;                            // [m]
  double peak = 0.0, pull = 0.0;                // [N], load on the tissue: largest so far, now
};

/// What the needle's point rests on.
struct PointContact {
  enum class Kind : std::int32_t { none, outside, within, boundary };  // within: advancing in open tissue; boundary: at a layer or the far side
  Kind kind = Kind::none;
  std::int32_t leaving = 0;    // boundary: the far surface
  WallPoint at;
  Vec3 normal = Vec3::UnitZ();  // outward where it rests
  double threshold = 0.0;      // [N]
  double force = 0.0;          // [N], normal, in the last step
};

/// Part of the state.
struct TrackState {
  std::int32_t n = 0;
  std::int32_t open = -1;      // track that the point is in
  std::array<NeedleTrack, kMaxTracks> tracks;
  PointContact point;
  Vec3 point_before = Vec3::Zero();  // [m], of the needle, end of the last step
  bool point_outside = false;  // it stood free then, within reach of the surface and on the outer side of it
  double dissipated = 0.0;     // [J], by friction, cutting and tearing so far
};

}  // namespace filum
