#include "training/stitch_knot.h"

#include <algorithm>

namespace filum {
namespace {

/// The longer and the shorter of the ends that were cut.
void measure_tails(const Observation& o, const ThreadPart& piece, bool cut_in_front, StitchKnot& k) {
  const double low = length_between(o, piece.first, piece.first + k.knot.core_begin);
  const double high = length_between(o, piece.first + k.knot.core_end, piece.last);
  const bool hangs_on_needle = piece.last == o.n_nodes - 1;
  k.tail = hangs_on_needle ? low : !cut_in_front ? high : std::max(low, high);
  k.short_tail = hangs_on_needle ? low : !cut_in_front ? high : std::min(low, high);
}

}  // namespace

StitchKnot knot_in_piece(const Observation& o, const ThreadPart& piece, int closures, bool cut_in_front) {
  StitchKnot k;
  if (piece.nodes() < 4) return k;
  KnotOptions options;
  options.closures = closures;
  k.knot = classify_knot(o.positions.middleCols(piece.first, piece.nodes()), o.radius, nullptr, options);
  if (k.knot.core_begin < 0) return k;
  k.begin = o.arc[static_cast<std::size_t>(piece.first + k.knot.core_begin)];
  k.end = o.arc[static_cast<std::size_t>(piece.first + k.knot.core_end)];
  measure_tails(o, piece, cut_in_front, k);
  return k;
}

std::vector<StitchKnot> knots_in_tissue(const Observation& o, int closures, const std::vector<char>& whole_front) {
  std::vector<StitchKnot> knots;
  std::vector<int> seen;  // first nodes of the pieces
  for (int i = 0; i < o.tissue.n_passes; ++i) {
    const double arc = o.tissue.passes[static_cast<std::size_t>(i)].arc;
    if (arc < 0.0) continue;
    const ThreadPart piece = piece_at(o, arc);
    if (std::find(seen.begin(), seen.end(), piece.first) != seen.end()) continue;
    seen.push_back(piece.first);
    const auto pass = static_cast<std::size_t>(i);
    knots.push_back(knot_in_piece(o, piece, closures, pass < whole_front.size() && whole_front[pass] == 0));
  }
  return knots;
}

double way_round(const StitchKnot& knot, const TissueObservation& tissue) {
  double way = 0.0;
  const Vec3 *first = nullptr, *last = nullptr;
  for (int i = 0; i < tissue.n_passes; ++i) {
    const PassObservation& p = tissue.passes[static_cast<std::size_t>(i)];
    if (!knot.holds(p.arc)) continue;
    if (last != nullptr) way += (p.entry_W - *last).norm();
    else first = &p.entry_W;
    way += (p.exit_W - p.entry_W).norm();
    last = &p.exit_W;
  }
  return last == nullptr ? 0.0 : way + (*last - *first).norm();
}

void name_knots(const StitchKnot& knot, const TissueObservation& tissue, std::vector<Stitch>& stitches) {
  for (Stitch& s : stitches) {
    const double first = tissue.passes[static_cast<std::size_t>(s.first)].arc;
    const double second = tissue.passes[static_cast<std::size_t>(s.second < 0 ? s.first : s.second)].arc;
    if (!knot.holds(first) || !knot.holds(second)) continue;
    s.knot = knot.knot.knot_class;
    s.throws = knot.knot.n_throws;
    s.tail = knot.tail;
    s.short_tail = knot.short_tail;
    s.slack = knot.loop() - way_round(knot, tissue);
  }
}

}  // namespace filum
