#pragma once
// The tissue of a scene and the needle's and thread's ways through it: what it holds them by, what they do to it, its own step.

#include "physics/implicit_rod.h"
#include "physics/needle.h"
#include "world/observation.h"
#include "world/vessel_contact.h"
#include "world/vessel_model.h"

namespace filum {

class VesselScene {
 public:
  VesselScene(const VesselModel& model, const NeedleShape& needle, int thread_capacity);

  /// The tissue as its stresses and clamps leave it; `point`: of the needle.
  VesselState start(const Vec3& point);
  void describe(TissueDescription& d) const;
  void size_observation(Observation& o) const;

  void hold(const VesselState& s, const Pose& X_WN, const RodState& thread, std::vector<RodTether>& on_needle, std::vector<RodTether>& on_thread) noexcept;
  /// The clamp's buttons: `next` (4) turns it over and back, `cut` (2) slides it while it is held down, the other way at each press. The tissue's
  /// step then carries the stumps along.
  void handle_clamp(VesselState& s, std::uint32_t buttons, Observation& o) const noexcept;
  /// Jaws against the tissue. Before step().
  void press(const VesselState& s, const std::vector<InstrumentParameters>& tools, const std::vector<InstrumentState>& states) noexcept;
  /// After step(): adds to the forces on the jaws.
  void feel(std::vector<Vec3>& force, std::vector<Vec3>& torque) const noexcept;
  /// After needle and thread have moved: loads, punctures and tears, then the tissue's own step.
  void step(VesselState& s, const Pose& X_WN, const RodState& thread, const std::vector<RodTether>& on_needle,
            const std::vector<RodTether>& on_thread, Observation& o) noexcept;
  void observe(const VesselState& s, const RodState& thread, Observation& o) const noexcept;
  /// After a state was restored.
  void match(const VesselState& s) noexcept { wall_.refit(s.wall); }

 private:
  void move_clamp(const VesselState& s) noexcept;

  const VesselModel& model_;
  VesselWall wall_;
  NeedleTracks tracks_;
  VesselContact contact_;
};

std::uint64_t hash_vessel(const VesselState& s) noexcept;

}  // namespace filum
