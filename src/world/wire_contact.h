#pragma once
// The needle's wire against the surface of the tissue: samples 0.1 mm apart, each a touch (surface_touch.h) at the wire's own radius.
//
// Needle and wall move in turn. A loose needle gives way to the wall (lean_touch). One in hand is a post, which stands against all faces that it meets
// within the wall's own step, as jaws do, and feels in its next step what they pushed in the last. A sample touches where it has gone in through the
// surface by its motion relative to the wall, or is nearer to its outer side than the wire is thick. Where a track holds the needle, 0.3 mm about it, and
// at the point (needle_track.h) nothing is looked for; over the next 0.2 mm the touch grows stiffer from nothing, so that what is drawn into a hole does
// not let go with a jerk.
// Neglects: flattened bodies, rims thinner than 0.1 mm between two samples. Test: wire_contact_test.

#include <array>
#include <cmath>

#include "physics/needle_shape.h"
#include "world/surface_touch.h"

namespace filum {

inline constexpr int kMostWireSamples = 96;
inline constexpr double kTrackFades = 0.2e-3;  // [m], beyond kTrackReach, over which a touch comes to its stiffness

class WireContact {
 public:
  explicit WireContact(const NeedleShape& needle);

  TouchLaw law;  // steel on wet tissue

  /// Before the needle moves from X_WN: what the surface holds it by; `held`: a hand holds it.
  void hold(const VesselWall& wall, const WallState& w, const TouchState& s, const TrackState& tracks, const Pose& X_WN, bool held,
            std::vector<RodTether>& on_needle) noexcept;
  /// [m], by which a step to X_WN takes a loose needle on where it is too deep for the wall to push back any harder; at most.
  double sinks(const VesselWall& wall, const WallState& w, const TouchState& s, const Pose& X_WN) const noexcept;
  /// After it has moved to X_WN: loads on the wall, and what it has come upon.
  void follow(VesselWall& wall, const WallState& w, TouchState& s, const TrackState& tracks, const Pose& X_WN, bool held,
              const std::vector<RodTether>& on_needle) noexcept;
  /// After the wall's step, before overtake(): how the wall pushed a needle in hand.
  void feel(const VesselWall& wall, TouchState& s) noexcept;
  /// After the wall's step: what has come upon it, or lies beside it.
  void overtake(const VesselWall& wall, const WallState& w, TouchState& s, const TrackState& tracks, const Pose& X_WN) noexcept;

 private:
  void find_shares(const TrackState& tracks) noexcept;
  double& share(double arc) noexcept { return share_[static_cast<std::size_t>(std::lround(arc / spacing_))]; }
  void touch(TouchState& s, int sample, const WallCrossing& c) noexcept;
  RodTether felt(const SurfaceTouch& touch, const Vec3& x) const noexcept;
  /// The touch of this number, of a needle in hand that has moved by `carried` [m] to x, stands against the wall with `stiffness` [N/m].
  void press(VesselWall& wall, const WallState& w, const SurfaceTouch& touch, int number, const TouchFooting& footing, double stiffness, const Vec3& x,
             const Vec3& carried) noexcept;

  NeedleShape needle_;
  int n_ = 0;                                     // samples, from the swage
  double spacing_ = 0.0;                          // [m]
  std::array<double, kMostWireSamples> share_{};  // of its stiffness that a touch there has; 0 also where one is, or has come off in this step
  struct Push {
    int number, touch;                            // of the wall; of the state
    double stiffness;                             // [N/m]
  };
  std::array<Push, 8 * kMostTouches> pushes_{};
  int n_pushes_ = 0;
  Pose before_;                                   // at the start of the step
  int first_ = 0;                                 // of its tethers
};

}  // namespace filum
