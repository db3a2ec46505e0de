#pragma once
// Tissue between the pads of an instrument. Jaws that come to touch tissue on both sides as they close hold the points of its surface under either pad, at up to three places
// along the pads, by bristles of stiffness k: f = k (pad - x), as long as |f| <= min(mu N, f_max)/places (Coulomb, N the grip force; f_max, what the tissue bears);
// beyond that the point slides along its pad until the bristle bears as much (return mapping), and a place of which a point has slid off its pad is let go.
//
// What can be held:
//   - the wall through its thickness (one of the two points is not on the outer surface), at most 2.5 times as thick: if both surfaces face the pads within 45 degrees [P].
//     (Rigid contacts close a force if the line between them lies in both friction cones: Nguyen, Int. J. Robotics Research 7(3):3, 1988; of 0.3 17 degrees. Tissue this
//     soft turns to lie against the pads, and its facets are up to 9 degrees off the round.)
//   - its adventitia: if both tips touch the outer surface as they come within 0.15 mm of each other [P]. It is loose: tips draw a fold of it between them, finer than any
//     element.
// Jaws stop where what lies between them is squeezed to four fifths.
// Constants marked [P] in wall_grasp.cpp are proposals. Neglects: that squeezing harms; torsional friction; that adventitia slides on the media. Test: wall_grasp_test.

#include "physics/instrument.h"
#include "physics/vessel_wall.h"
#include "physics/wall_grip.h"

namespace filum {

/// An instrument as it is now.
struct GrippingTool {
  const InstrumentParameters& parameters;
  const InstrumentState& state;
};

struct GrippedWall {
  double thickness = 0.0;                  // [m]
  bool adventitia = false;                 // its outside is loose
};

/// Holds what lies between pads that touch it on both sides: true if there is something. Asks the surface given to refit().
bool take_wall(const VesselWall& wall, const WallState& w, const GrippingTool& tool, const GrippedWall& kind, WallGrip& grip) noexcept;
/// Loads of the coming step; what bears too much has slid first. Grips nothing any more once all has slid off.
void pull_wall(VesselWall& wall, const WallState& w, const GrippingTool& tool, WallGrip& grip) noexcept;
/// After the wall's step: what the tissue does to the instrument, about its tip, is added to force [N] and torque [N m].
void feel_wall(const VesselWall& wall, const WallState& w, const GrippingTool& tool, WallGrip& grip, Vec3& force, Vec3& torque) noexcept;

/// [N], of all points under one pad together, that this grip can bear.
double grip_limit(const WallGrip& grip, double grip_force) noexcept;

}  // namespace filum
