#pragma once
// The tissue of a scene and the needle's and thread's ways through it: what it holds them by, what they do to it, its own step.

#include <algorithm>
#include <memory>

#include "physics/implicit_rod.h"
#include "physics/needle.h"
#include "physics/wall_grasp.h"
#include "world/observation.h"
#include "world/blood_flow.h"
#include "world/stray_thread.h"
#include "world/vessel_contact.h"
#include "world/vessel_model.h"
#include "world/wire_contact.h"

namespace filum {

class VesselScene {
 public:
  VesselScene(const VesselModel& model, const NeedleShape& needle, int thread_capacity);

  /// The tissue as its stresses and clamps leave it; `point`: of the needle.
  VesselState start(const Vec3& point);
  void size_observation(Observation& o) const;

  /// What the tissue holds needle and thread by in the coming step; `held`: a hand holds the needle.
  void hold(const VesselState& s, const Pose& X_WN, bool held, const RodState& thread, std::vector<RodTether>& on_needle, std::vector<RodTether>& on_thread) noexcept;
  /// Has the thread's step taken it through the tissue? Then it is to be made again, with what has come onto `on_thread`.
  bool catches(VesselState& s, const RodState& thread, std::vector<RodTether>& on_thread) const noexcept { return contact_.catches(wall_, s.wall, s.touches, s.tracks, thread, on_thread); }
  /// [m], by which it has taken thread, or a loose needle to X_WN, on through tissue that pushes back no harder.
  double sinks(const VesselState& s, const RodState& thread, const Pose& X_WN, bool held) const noexcept {
    return std::max(contact_.sinks(wall_, s.wall, s.touches, thread), held ? 0.0 : wire_.sinks(wall_, s.wall, s.wire, X_WN));
  }
  /// The clamp's buttons: `next` (4) turns it over and back, or to the next of the scene's turns, `cut` (2) slides it while it is held down, the other way at each press. The tissue's
  /// step then carries the stumps along. 8 and 16 take the upstream and the downstream clamp off; then it moves no more.
  void handle_clamp(VesselState& s, std::uint32_t buttons, Observation& o) const noexcept;
  /// True if these jaws, closing, have just opened a clamp.
  bool open_clamp(VesselState& s, int tool, const GrippingTool& t, Observation& o) const noexcept { return blood_ && blood_->open_with(s, tool, t.parameters, t.state, o); }
  /// [rad], at which jaws rest on the tissue they hold, or press a vessel flat that they have between them; 0 where they do not.
  double stop_angle(const VesselState& s, int tool, const GrippingTool& jaws) const noexcept;
  /// Jaws that `may_take` hold the tissue between them; opened they let it go.
  void meet_jaws(VesselState& s, int tool, const GrippingTool& jaws, bool may_take, Observation& o) const noexcept;
  /// After the tools have moved from `from`: those that would have gone through tissue are held back at it.
  void hold_back(const VesselState& s, const std::vector<InstrumentParameters>& tools, const std::vector<ObstacleBody>& from, std::vector<InstrumentState>& states) const noexcept;
  /// Jaws against the tissue, and blood. Before step().
  void press(VesselState& s, const std::vector<InstrumentParameters>& tools, const std::vector<InstrumentState>& states, Observation& o) noexcept;
  /// After step(): adds to the forces on the jaws.
  void feel(VesselState& s, const std::vector<InstrumentParameters>& tools, const std::vector<InstrumentState>& states, std::vector<Vec3>& force,
            std::vector<Vec3>& torque) const noexcept;
  /// After needle and thread have moved: loads, punctures and tears, then the tissue's own step.
  void step(VesselState& s, const Pose& X_WN, bool held, const RodState& thread, const std::vector<RodTether>& on_needle,
            const std::vector<RodTether>& on_thread, Observation& o) noexcept;
  void observe(const VesselState& s, const RodState& thread, Observation& o) const noexcept;
  /// After a state was restored.
  void match(const VesselState& s) noexcept { wall_.refit(s.wall); }

 private:
  void fall_flat(VesselState& s);
  void move_clamp(const VesselState& s) noexcept;

  const VesselModel& model_;
  VesselWall wall_;
  NeedleTracks tracks_;
  VesselContact contact_;
  StrayThread stray_;
  WireContact wire_;
  std::unique_ptr<BloodFlow> blood_;  // of two stumps in clamps
};

std::uint64_t hash_vessel(const VesselState& s) noexcept;

}  // namespace filum
