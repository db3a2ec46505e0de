#pragma once
// Where a beginner may put the next stitches: places for the needle to go in and out on either side of the cut, and the way of its point
// there, square to the surface. Guides are drawn, they are not scored. A guide stands where the task asks for a stitch (stitch_places.h), two
// thirds of a wide bite from the cut edge (a vessel: two wall thicknesses); its needle turns about a centre in the plane of the surface, so
// that it enters at a right angle (MSV), with the needle's own radius. Numbers are proposals [P]. Test: stitch_guide_test.

#include <vector>

#include "training/needle_task.h"
#include "world/observation.h"

namespace filum {

struct GuidePlace {
  Vec3 at = Vec3::Zero();   // [m], on the tissue at rest
  int vertex = -1;          // of the tissue, nearest: the place moves with it
  std::vector<Vec3> path;   // [m], of the needle's point, into the tissue (first place) or out of it (second)
};

struct StitchGuide {
  GuidePlace in, out;
};

/// One for each stitch that the task asks for, in their order. None without tissue or needle, or where the task does not tell places.
std::vector<StitchGuide> stitch_guides(const TissueDescription& tissue, const NeedleDescription& needle, const NeedleTask& task);

/// Marks of a needle course, printed on its card: in and out of each eye, without a path.
std::vector<StitchGuide> eye_marks(const std::vector<NeedleGoal>& goals, const TissueDescription& tissue);

}  // namespace filum
