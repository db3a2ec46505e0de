#pragma once
// How the files of problems enter theirs in the list.

#include <functional>
#include <string>
#include <vector>

#include "evidence/validation.h"

namespace filum {

/// `stated` says everything but the result; `solve` fills got and, where it has one, order.
struct ListedProblem {
  ValidationProblem stated;
  std::function<void(ValidationProblem&)> solve;
};

using ProblemList = std::vector<ListedProblem>;

void list_elastica(ProblemList& list);  // bending at rest
void list_dynamics(ProblemList& list);  // vibration, momentum
void list_twist(ProblemList& list);     // twisting and its instabilities
void list_localized_helix(ProblemList& list);  // a twisted rod that buckles in its middle
void list_frames(ProblemList& list);    // directors carried along: holonomy, writhe
void list_friction(ProblemList& list);  // sliding on a plane and round a bar
void list_wall_capstan(ProblemList& list);  // sliding round a vessel
void list_knots(ProblemList& list);     // tight knots
void list_plectoneme(ProblemList& list);  // a twisted rod wound round itself
void list_passages(ProblemList& list);  // that there are none
void list_tissue(ProblemList& list);    // brain: elements, time, half space, solvers
void list_spatula(ProblemList& list);   // blade on tissue
void list_vessel(ProblemList& list);    // tubes, the carotid, the ring
void list_vessel_stress(ProblemList& list);   // stress in the wall of tubes
void list_vessel_cut(ProblemList& list);      // a ring that springs open
void list_vessel_element(ProblemList& list);  // the wall's element alone
void list_needle_track(ProblemList& list);  // a needle through tissue

}  // namespace filum
