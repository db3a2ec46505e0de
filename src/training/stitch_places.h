#pragma once
// Where the stitches that a task asks for belong, for guides and for nothing else: the rules leave room, and a stitch elsewhere within them is as good.
//
// Round a closed cut as many places as stitches are asked for, evenly spaced from the middle of the first one's sector (with no sector: what lies on top),
// and of these in each turn one that the order of stitches takes (training/stitch_order.h), the farthest from those before. Where the rules cannot be met
// so, and where nothing says how the stitches lie, there are none. On a card along the cut. Test: stitch_places_test.

#include <vector>

#include "training/needle_task.h"
#include "world/observation.h"

namespace filum {

/// [rad], of a closed cut, from where its angle is zero, as they are to be sewn.
std::vector<double> stitch_angles(const std::vector<NeedleGoal>& goals, const TissueDescription& tissue);

/// [m], along the straight cut of a card from its middle, at most 1 mm apart and within its width.
std::vector<double> stitches_along(const std::vector<NeedleGoal>& goals, const TissueDescription& tissue);

}  // namespace filum
