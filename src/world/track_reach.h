#pragma once
// Stretches of the thread that tracks hold, with what lies beside them: there it is left alone by what keeps thread out of the tissue.
// Arcs [m] are of the thread, as its touches count them (surface_touch.h).

#include <array>

#include "physics/elastic_rod.h"
#include "physics/track_state.h"
#include "world/surface_touch.h"

namespace filum {

struct TrackReach {
  double from = 0.0, to = 0.0;   // [m], of the thread's arc
  WallPoint low, high;           // mouths of the track, at the lesser and at the greater arc
};

class TrackReaches {
 public:
  /// `beside` [m]: on either side of a track.
  TrackReaches(const TrackState& tracks, const RodState& thread, double beside = kTrackReach) noexcept;
  /// The one that holds the thread there; null: none.
  const TrackReach* at(double arc) const noexcept;
  bool hold(double arc) const noexcept { return at(arc) != nullptr; }
  /// [m], where the next one begins.
  double next(double arc) const noexcept;
  /// All of n samples along an edge that begins at `arc`.
  bool hold_all(double arc, double length, int n) const noexcept;
  static double sample(double arc, double length, int k, int n) noexcept { return arc + static_cast<double>(k) / n * length; }

 private:
  std::array<TrackReach, kMaxTracks> reaches_;
  std::size_t n_ = 0;
};

}  // namespace filum
