#include "training/stitch_knot.h"

#include <algorithm>

#include "training/thread_part.h"

namespace filum {
namespace {

double cut_tail(const Observation& o, const ThreadPart& part, const KnotReport& knot) {
  const double low = length_between(o, part.first, part.first + knot.core_begin);
  const double high = length_between(o, part.first + knot.core_end, part.last);
  if (o.cut_edge_high < 0) return low;
  return o.cut_edge_low < 0 ? high : std::max(low, high);
}

}  // namespace

StitchKnot knot_in_tissue(const Observation& o, int closures) {
  StitchKnot k;
  const ThreadPart part = tied_part(o);
  if (part.nodes() < 4) return k;
  KnotOptions options;
  options.closures = closures;
  k.knot = classify_knot(o.positions.middleCols(part.first, part.nodes()), o.radius, nullptr, options);
  if (k.knot.core_begin < 0) return k;
  k.begin = o.arc[static_cast<std::size_t>(part.first + k.knot.core_begin)];
  k.end = o.arc[static_cast<std::size_t>(part.first + k.knot.core_end)];
  k.tail = cut_tail(o, part, k.knot);
  return k;
}

void name_knots(const StitchKnot& knot, const TissueObservation& tissue, std::vector<Stitch>& stitches) {
  for (Stitch& s : stitches) {
    const double first = tissue.passes[static_cast<std::size_t>(s.first)].arc;
    const double second = tissue.passes[static_cast<std::size_t>(s.second < 0 ? s.first : s.second)].arc;
    if (!knot.holds(first) || !knot.holds(second)) continue;
    s.knot = knot.knot.knot_class;
    s.throws = knot.knot.n_throws;
    s.tail = knot.tail;
  }
}

}  // namespace filum
