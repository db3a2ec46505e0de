#pragma once
// The double clamp as thread, needle and instruments touch it: at each held end two arms, on either side of the vessel, which stand out above and below
// it; the vessel that goes on behind them (thread only: tissue gives way to tools); the bar below that joins the clamps. Round bars, each clamp a body
// that goes with the clamp's buttons. A clamp that was taken off is touched no more; with one off the bar is gone.
// Neglects: the arms' contact with the wall, whose held end is between them. Test: clamp_bars_test.

#include <vector>

#include "physics/instrument_contact.h"
#include "physics/rod_obstacle.h"
#include "world/vessel_model.h"
#include "world/vessel_state.h"

namespace filum {

/// Where the vessel is held by a clamp: origin on its axis, z towards the cut. It turns with the clamp. 0 upstream, 1 downstream, 2 the one that stays on (end to side).
Pose held_end(const VesselModel& vessel, const ClampState& clamp, int which) noexcept;
inline int n_clamps(const VesselModel& vessel) noexcept { return vessel.clamp.side ? 3 : 2; }

/// [m], of the arms: distance of their axes from the vessel's, how far they reach from it, how far behind the held end they stand.
struct ClampArms {
  double radius = 0.2e-3, beside = 0.0, reach = 0.0, behind = 0.35e-3;
};
inline ClampArms clamp_arms(const VesselModel& vessel) noexcept {
  ClampArms arms;
  arms.beside = 0.55 * vessel.radius + arms.radius;
  arms.reach = vessel.radius + 0.6e-3;
  return arms;
}

class ClampBars {
 public:
  explicit ClampBars(const VesselModel& vessel);

  /// Its bodies and bars, behind those that are there; before the first step.
  void add(const ClampState& clamp, double friction, RodObstacles& obstacles);
  /// Where they go in this step, the clamp's buttons having been heard.
  void move(const VesselState& s, RodObstacles& obstacles) noexcept;
  /// After a state was restored: they are there.
  void match(const VesselState& s, RodObstacles& obstacles) noexcept;
  /// What tools and the needle touch of it, at the end of the step: arms and bar, frame W.
  const std::vector<RoundBar>& solid() const noexcept { return solid_; }

 private:
  bool on(const VesselState& s, int clamp) const noexcept { return clamp >= 2 || s.blood.off[static_cast<std::size_t>(clamp)] == 0; }
  void collect(const RodObstacles& obstacles) noexcept;

  const VesselModel& model_;
  std::size_t first_body_ = 0, first_obstacle_ = 0;
  std::vector<RoundBar> solid_;
};

}  // namespace filum
