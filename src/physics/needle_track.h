#pragma once
// The way of needle and thread through tissue: puncture, track, friction, tearing.
//
// A track is a curve through material points of the wall (knots), laid down by the needle's point. It does not depend on the wall's
// nodes. Each knot holds whatever runs through it, needle or thread: a spring across the strand, dry and speed-dependent friction
// along it (rod_tether.h), and gives the tissue the opposite load.
//   Hold      Tissue stiffens as the strand is drawn aside by d in it: F = k d (1 + d^2/d_s^2), straight on from d = 2 d_s. A step takes it as linear about where
//             it begins (Newton's first iteration). By it a small bite tears before the strand has come to the edge; a rubber has no d_s.
//   Puncture  Layer by layer. The point rests on a layer until the normal part of its force reaches the layer's threshold, so that
//             along the needle the force is F0 / sin(angle to the surface); below the least angle the point slides.
//   Insertion  F = F_cut + sum over the length inside (f + c v): linear in depth (Okamura, Simone & O'Leary, IEEE TBME 51:1707, 2004).
//   Strand    runs through a knot the way its edge does in the edge's middle and turns between two of them over the node: as straight edges a bend would turn a
//             knot's friction and hold by its whole angle when the node is drawn through. Its order along the track is kept: it has no room to turn back in it.
//   Bends     Each knot adds mu times its lateral force: summed over a bend this is the capstan.
//   Sawing    The hole's radius grows by wear x lateral force x length drawn through (Archard).
//   Tearing   A track bears at most tear x bite (distance of its knot nearest to the cut edge); beyond that all of it moves through the
//             tissue the way it is pulled, until its load is what it bears. As the bite shrinks so does that, and the rest lets go at once.
// Neglects: cracks ahead of the knot, healing of stretch; a tear leaves the elements whole. Constants are orders of magnitude from
// clinical.md 4 and 6 (proposals). Tests: needle_track_test; `filum validate` track-*.

#include <array>
#include <vector>

#include "physics/needle.h"
#include "physics/track_state.h"
#include "physics/vessel_wall.h"
#include "physics/wall_walk.h"

namespace filum {

struct PunctureLayer {
  double puncture = 5e-3;     // [N], normal force at which the point goes in
  double cutting = 1e-3;      // [N], at the point while it advances
  double friction = 5.0;      // [N/m], dry, for each length of needle inside
  double drag = 50.0;         // [N s/m2], each length and speed
  double stiffness = 0.0;     // [N/m], under a point that rests on it; 0: the material's point_stiffness
};

struct TrackMaterial {
  std::vector<PunctureLayer> layers;  // inner first, as VesselWall::layer_at counts
  double hold = 400.0;           // [N/m], k of a knot across the strand
  double stiffens = 0.0;         // [m], d_s; 0: it does not
  double point_stiffness = 1500.0;  // [N/m], tissue just under the point
  double least_angle = 0.26;     // [rad], below which the point slides off
  double thread_share = 0.4;     // friction and drag of thread over those of needle
  double bend_friction = 0.15;   // [-], mu
  double tear = 500.0;           // [N/m], force for each length of bite
  double exit_share = 0.3;       // threshold of the far side, where the tissue is already split, over that of going in
  double wear = 2e-2;            // [1/N], growth of the hole's radius for each force and length drawn
  double spacing = 60e-6;        // [m], of knots
};

/// What a knot holds a strand by that is drawn aside by `give` [m]: force [N] and its slope [N/m].
struct KnotHold {
  double force, slope;
};
KnotHold knot_hold(const TrackMaterial& m, double give) noexcept;

struct TrackEvent {
  const char* name = "";       // "puncture" (value: normal force), "needle-out", "pulled-back", "tear" (value: force), "torn-out"
  double value = 0.0;          // [N]
};

/// What a tethered strand does to the wall in its coming step: a spring across the strand, and along it dry friction that lets go of the wall where it
/// lets go of the strand.
void load_wall(VesselWall& wall, const WallState& w, const WallPoint& at, const RodTether& t, double dt) noexcept;

class NeedleTracks {
 public:
  NeedleTracks(TrackMaterial material, const NeedleShape& needle, const VesselWall& wall);

  const TrackMaterial& material() const noexcept { return material_; }
  const WallWalk& walk() const noexcept { return walk_; }

  /// What the tissue holds in this step: added to the tethers of the needle and, from index `on_thread.size()` on, of the thread.
  void hold(const VesselWall& wall, const WallState& w, const TrackState& s, const Pose& X_WN, const RodState* thread,
            std::vector<RodTether>& on_needle, std::vector<RodTether>& on_thread) noexcept;
  /// After needle and thread have moved: loads on the wall, what slid, what was pierced or torn. Returns the number of events.
  int follow(VesselWall& wall, const WallState& w, TrackState& s, const Pose& X_WN, const RodState* thread, double dt,
             const std::vector<RodTether>& on_needle, const std::vector<RodTether>& on_thread, TrackEvent* events, int room) noexcept;
  /// Before and after the wall's step: where the point was moves with the surface that it is near. What tells a contact is motion relative to
  /// the wall; a wall that comes upon a point would else pass it unseen.
  void mark_point(const VesselWall& wall, const WallState& w, const TrackState& s) noexcept;
  void carry_point(const VesselWall& wall, const WallState& w, TrackState& s) const noexcept;

 private:
  struct Use {
    int track, knot, tether;
    bool needle;
    double before;  // [m], strand
  };
  struct Events {
    TrackEvent* list;
    int room, n;
    void say(const char* name, double value) noexcept {
      if (n < room) list[n++] = {name, value};
    }
  };
  const PunctureLayer& layer(int k) const noexcept { return material_.layers[std::min(static_cast<std::size_t>(k), material_.layers.size() - 1)]; }
  /// What a point that rests there feels. [N/m]
  double under(const VesselWall& wall, const WallPoint& at) const noexcept {
    const double own = layer(wall.layer_at(at)).stiffness;
    return own > 0.0 ? own : material_.point_stiffness;
  }
  RodTether tether_of(const VesselWall& wall, const WallState& w, const TrackKnot& k, double arc, const Vec3& along, const Vec3& x, double share) const noexcept;
  void draw_aside(RodTether& t, const Vec3& x) const noexcept;
  void hold_point(const VesselWall& wall, const WallState& w, const TrackState& s, const Pose& X_WN, std::vector<RodTether>& on_needle) noexcept;
  void take_knot(VesselWall& wall, const WallState& w, TrackState& s, const Use& u, const RodTether& t, double dt) noexcept;
  void tear(const VesselWall& wall, const WallState& w, TrackState& s, NeedleTrack& track, const Vec3& load, Events& e) noexcept;
  void take_point(VesselWall& wall, const WallState& w, TrackState& s, const Pose& X_WN, const std::vector<RodTether>& on_needle, double dt, Events& e) noexcept;
  void rest_on_surface(VesselWall& wall, const WallState& w, TrackState& s, const RodTether& t, const Vec3& tip, const Vec3& along, Events& e) noexcept;
  void advance(const VesselWall& wall, const WallState& w, TrackState& s, const RodTether& t, const Vec3& tip, const Vec3& along) noexcept;
  void break_through(const VesselWall& wall, const WallState& w, TrackState& s, const RodTether& t, const Vec3& along, Events& e) noexcept;
  void find_contact(const VesselWall& wall, const WallState& w, TrackState& s, const Vec3& before, const Vec3& tip, const Vec3& along) noexcept;
  void open_track(const VesselWall& wall, const WallState& w, TrackState& s, double angle) noexcept;
  void lay_knot(const VesselWall& wall, TrackState& s, const WallPoint& at) noexcept;
  void drop_passed(TrackState& s, Events& e) noexcept;
  void drop_ended(TrackState& s, const RodState& thread) noexcept;

  TrackMaterial material_;
  NeedleShape needle_;
  WallWalk walk_;
  std::vector<Use> uses_;
  std::array<Vec3, kMaxTracks> load_;  // [N], on the tissue of each track in this step
  int point_tether_ = -1;
  bool near_ = false;        // the needle's point stands free within reach of the surface,
  bool outside_ = false;     // on its outer side,
  WallPoint beside_;         // next to this material point,
  Vec3 beside_W_;            // [m], which was here before the wall's step
};

}  // namespace filum
