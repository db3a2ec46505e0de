#pragma once
// Thread and needle that lie in the tissue where no track leads: they have come into a wall, or through it, past what should keep them out.
//
// The strand is looked at every 10 um where it is near the tissue. A sample is deep in it where less than kDeepShare of the tissue's thickness, measured there from side to side
// through the sample, lies between it and neither side: what goes through a wall comes by there however it slants, what is pressed into a surface or cuts across a rim does not.
// Left alone are stretches within the reach of a track (kTrackReach, of a needle also kTrackFades; beyond the needle's point while a track is open), and what a touch draws back the way
// it came: one near by, whose own place on the strand is half as deep below where it went in, and that none pushes against from the other side. Each place is followed, by the strand or by the wall, for as long as it stays.
// Neglects: what slips in where a frame or clamp holds the border, which has no surface there, what goes in and through between two steps, elements that are gone, what lies less than kDeepShare deep. Test: wall_watch_test.

#include <optional>
#include <span>
#include <vector>

#include "physics/vessel_wall.h"
#include "world/model.h"
#include "world/state.h"

namespace filum {

inline constexpr double kDeepShare = 0.3;  // of the thickness: 30 um of a wall of 0.1 mm, where touches push their hardest (kDeepest)

/// A place of the strand that is deep in the tissue.
struct BuriedStrand {
  double strand = 0.0;  // [m], arc of the needle from its swage; negative: thread behind it
  double depth = 0.0;   // [m], below the nearest side
  double share = 0.0;   // of the thickness there; 0.5: the middle
  WallPoint at;         // of the surface, nearest
  int steps = 0;        // on end, this one included
};

class WallWatch {
 public:
  explicit WallWatch(const Model& model);

  /// After a step. Does nothing in scenes without tissue.
  void look(const State& s);
  std::span<const BuriedStrand> buried() const noexcept { return places_; }
  /// The one that has been there longest; `steps` 0: none.
  BuriedStrand longest() const noexcept;

 private:
  struct Stretch {
    double from, to;  // [m], of the strand
  };
  void find_tracks(const State& s);
  void look_along_thread(const State& s);
  void look_along_needle(const State& s);
  template <class At>
  void walk(const State& s, double from, double to, const At& at);
  void take(const State& s, double strand, const Vec3& x, const WallCrossing& near);
  double share_of_thickness(const WallState& w, const Vec3& x, const WallCrossing& near) const;
  bool drawn_back(const State& s, double strand, double depth) const;
  bool in_track(double strand) const noexcept;
  int steps_of(const WallState& w, const BuriedStrand& place) const;

  double thickness_ = 0.0;         // [m]
  NeedleShape needle_;
  std::optional<VesselWall> wall_;  // its own, which goes where the scene's is; none where there is no tissue
  std::vector<char> held_;         // of each node
  double whole_ = 0.0;             // [m], arc of the thread's end
  std::vector<Stretch> tracks_;
  std::vector<BuriedStrand> places_, before_;
};

}  // namespace filum
