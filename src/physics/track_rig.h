#pragma once
// A needle in a vice driven through a thick block: what a puncture rig does.

#include <memory>

#include "physics/needle_track.h"

namespace filum {

struct RigOptions {
  double thickness = 1e-3;        // [m], of the block
  double young = 100e6;           // [Pa], stiff: what gives is the needle's point and its track
  double angle = 1.5707963;       // [rad], of the needle against the surface
  double bite = 0.6e-3;           // [m], of the entry from the cut edge
  double bend_radius = 0.5;       // [m], of the needle: nearly straight
  double grip = 20.0;             // [N]
  double dt = 2e-3;               // [s]
  TrackMaterial track;
  std::vector<WallLayer> layers;  // inner first; empty: one of the whole thickness
};

/// Records of one step.
struct RigSample {
  double travel = 0.0;  // [m], of the vice along the needle since the first touch of the point
  double force = 0.0;   // [N], of the vice along the needle
};

class TrackRig {
 public:
  explicit TrackRig(const RigOptions& o);

  /// Moves the vice by `move` [m] along the needle (and `sideways` along the cut's normal, towards the edge) in one step.
  RigSample step(double move, double sideways = 0.0);
  const TrackState& tracks() const { return state_; }
  const NeedleState& needle() const { return needle_; }
  const NeedleShape& shape() const { return shape_; }
  const TrackMaterial& material() const { return tracks_->material(); }
  double work() const { return work_; }        // [J], by the vice
  double stored() const;                       // [J], in the holds of needle and tissue
  double inserted() const;                     // [m], length of needle beyond the entry
  double ahead() const;                        // [m], of it beyond the last knot
  const char* last_event() const { return last_event_; }
  double event_force() const { return event_force_; }  // [N], of the last event

 private:
  RigOptions options_;
  std::unique_ptr<VesselWall> wall_;
  WallState wall_state_;
  NeedleShape shape_;
  std::unique_ptr<NeedleBody> body_;
  std::unique_ptr<NeedleTracks> tracks_;
  NeedleState needle_;
  NeedleOptions needle_options_;
  TrackState state_;
  Pose vice_;
  Vec3 along_ = -Vec3::UnitZ(), last_force_ = Vec3::Zero();
  double travel_ = 0.0, work_ = 0.0, event_force_ = 0.0;
  const char* last_event_ = "";
  std::vector<RodTether> none_;
};

/// A track with one layer and these constants; no friction of bends, no wear.
TrackMaterial plain_track(double puncture, double cutting, double friction, double drag = 0.0);

}  // namespace filum
