#pragma once
// Which set of effects the evidence asks for: the smallest that the next larger one does not beat.

#include "reconcile/detect.h"

namespace filum::reconcile {

std::vector<Effect> effects_in(const Fit& f);
/// Whether the larger set earns its place beside the smaller one as a pair must beside a single: by evidence, by its size and by its share of the gap.
bool earns_its_place(const Candidates& sets, const Fit& smaller, const Fit& larger);
/// The smallest set that the next larger one does not beat; null: nothing is named, or the residual is one that noise makes (above `detect_p`). Fills in the
/// chance of the best single.
const Fit* choose(const Candidates& sets, double detect_p, DetectSummary& detected);

}  // namespace filum::reconcile
