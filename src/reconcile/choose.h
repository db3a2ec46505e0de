#pragma once
// Which set of effects the evidence asks for: the smallest that the next larger one does not beat.

#include "reconcile/search.h"

namespace filum::reconcile {

std::vector<Effect> effects_in(const Fit& f);
/// Whether the larger set earns its place beside the smaller one as a pair must beside a single: by evidence, by its size and by its share of the gap.
bool earns_its_place(const Search& search, const Fit& smaller, const Fit& larger, const Rules& rules);
/// The smallest set that the next larger one does not beat; null: nothing is named. Fills in the chance of the best single.
const Fit* choose(const Search& search, const Rules& rules, Detection& detection);

}  // namespace filum::reconcile
