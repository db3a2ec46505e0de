#pragma once
// Thread that has come to lie deep in the tissue where no track leads and no touch draws it out, as when it is dragged out of the reach of a track or is left by one that tears out:
// it is given touches (surface_touch.h) that lead it out again.
//
// Deep is what has no less than kDeepShare of the tissue's thickness on either side, there and as first made: what is pressed into a surface or cuts across a rim has not.
// A stretch lies in the tissue from where the thread crosses the surface inwards, or leaves a track's reach within it, to where it comes out or into another reach. What is deep in it and was
// so in the look before gets touches. All of it goes out on one side: where a touch already draws some of it; else where the mouth is that it comes from; else where the thread comes
// out next to its deepest place. Touches in it that push the other way end. Thread that is pulled harder than touches bear (90 mN/mm) stays, and they with it.
// Neglects: the needle; a stretch's very ends, of which that at a reach is its deepest place (DECISIONS.md); cuts: in truth thread that is pulled through tissue parts it. Test: stray_thread_test.

#include <array>
#include <optional>
#include <span>

#include "physics/vessel_wall.h"
#include "world/track_reach.h"

namespace filum {

class StrayThread {
 public:
  explicit StrayThread(double thickness) : deep_(kDeepShare * thickness) {}

  /// After the wall's step; looks in every fifth. Returns the touches given.
  int step(const VesselWall& wall, const WallState& w, const TrackState& tracks, const RodState& thread, StrayState& strays, TouchState& s) noexcept;

 private:
  struct End {
    double arc;            // [m]
    Vec3 out;              // unit, away from the tissue; zero where the thread itself ends
    bool mouth = false;    // of a track
  };
  struct Sample {
    double arc, depth;     // [m]
    Vec3 x;                // [m]
  };
  struct Scene {
    const VesselWall& wall;
    const WallState& w;
    const RodState& thread;
    const StrayState& before;  // the last look's
    double whole;              // [m], arc of the swage
  };
  static constexpr double kDeepShare = 0.3;  // of the tissue's thickness
  static constexpr std::size_t kMostSamples = 64;

  void look(const Scene& c, const TrackState& tracks, TouchState& s) noexcept;
  void pass(const Scene& c, int edge, double arc, double from, double to, TouchState& s) noexcept;
  void leave(const Scene& c, const End& end, TouchState& s) noexcept;
  bool lies_deep(const Scene& c, double from, double to) noexcept;
  static bool amid(const Scene& c, const Vec3& x, const WallCrossing& near) noexcept;
  bool was_seen(const Scene& c, const Sample& q) const noexcept;
  bool drawn(const Sample& q, const TouchState& s) const noexcept;
  Vec3 way_out(const End& from, const End& to, const TouchState& s) const noexcept;
  void draw(const Scene& c, const Vec3& way, TouchState& s) noexcept;
  std::span<const Sample> samples() const noexcept { return {samples_.data(), n_}; }

  double deep_;                               // [m]
  std::optional<End> in_;                     // where the stretch began that the walk along the thread is in
  std::array<Sample, kMostSamples> samples_;  // of it
  std::size_t n_ = 0;
  std::array<double, kMostTouches> below_{};  // [m], by which the thread is below each touch
  int given_ = 0;
  StrayState now_;                            // what this look finds
};

}  // namespace filum
