#pragma once
// Clamps that the trainee takes off a vessel, the blood that then comes, and forceps that milk it (physics/vessel_flow.h).
//
// A clamp comes off by its button, or when jaws close on both of its arms. From then on the pressure of each stump goes, at no more
// than 100 mmHg in a tenth of a second, to that of the balance of artery, join and what lies behind; the second stump follows the first.
// The gaps of the cut edge are measured one node a step, round and round.
// Forceps hold the vessel shut where its centre line passes between their jaws and these are as near as the pressed wall lets them be.
// End to side, blood comes down the vessel with the opening and goes on through the stump; that vessel's far clamp stays on.
// An emptied stretch takes its share of the second stump's pressure away (pressure is one number for each stump).
// Neglects: what lies behind a clamp stays where the clamp held it.
// Test: blood_flow_test.

#include <array>

#include "physics/instrument.h"
#include "physics/vessel_flow.h"
#include "world/clamp_bars.h"
#include "world/observation.h"
#include "world/vessel_model.h"
#include "world/vessel_state.h"

namespace filum {

/// The held end, y up those of the clamp's arms that can be seen best.
Pose clamp_pose(const VesselModel& vessel, const ClampState& clamp, int which) noexcept;

class BloodFlow {
 public:
  explicit BloodFlow(const VesselModel& vessel);

  /// Buttons 8 and 16.
  void hear(BloodState& b, std::uint32_t buttons, Observation& o) const noexcept;
  /// Do these jaws close on both arms of a clamp that is on? Then it comes off.
  bool open_with(VesselState& s, int tool, const InstrumentParameters& jaws, const InstrumentState& state, Observation& o) const noexcept;
  /// Least angle [rad] of jaws that have the vessel between them, its wall pressed flat; 0 where they do not.
  double stop_angle(const WallState& wall, const InstrumentParameters& tool, const InstrumentState& state) noexcept;
  /// Before the wall's step: pressures, gaps, what is lost, milking.
  void step(VesselState& s, const std::vector<InstrumentParameters>& tools, const std::vector<InstrumentState>& states, Observation& o) noexcept;
  void observe(const VesselState& s, BloodObservation& o) noexcept;

 private:
  struct Between {
    double along = -1.0;  // [m], where on the line; negative: not between the jaws
    double depth = 0.0;   // [m], from the tips, along the tool
  };
  void measure(BloodState& b, const WallState& wall) noexcept;
  void let_forceps_milk(BloodState& b, const std::vector<InstrumentParameters>& tools, const std::vector<InstrumentState>& states, Observation& o) const noexcept;
  Between between(const InstrumentParameters& tool, const InstrumentState& state) const noexcept;
  bool squeezes(const ClampState& clamp, int which, const InstrumentParameters& jaws, const InstrumentState& state) const noexcept;
  Balance balance(const BloodState& b) const noexcept;
  void take_off(BloodState& b, int which, int tool, Observation& o) const noexcept;

  const VesselModel& model_;
  LumenLine line_;
  Circulation circulation_;
  BloodOptions blood_;
};

}  // namespace filum
