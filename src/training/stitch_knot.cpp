#include "training/stitch_knot.h"

#include <algorithm>
#include <optional>

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

/// Places of the thread [m] in the ways that the knot holds, from the short end on.
std::vector<double> held_ways(const Observation& o, const StitchKnot& knot) {
  std::vector<double> held;
  for (int i = 0; i < o.tissue.n_passes; ++i)
    if (const double arc = o.tissue.passes[static_cast<std::size_t>(i)].arc; knot.holds(arc)) held.push_back(arc);
  std::sort(held.begin(), held.end());
  return held;
}

KnotReport look_at(const Observation& o, const ThreadPart& piece, const KnotOptions& options) {
  return classify_knot(o.positions.middleCols(piece.first, piece.nodes()), o.radius, nullptr, options);
}

/// The piece up to the way by which a part of the sum is tied: its first stitch has two before that. No nodes if there is none.
ThreadPart first_tied(const Observation& o, const ThreadPart& piece, const StitchKnot& sum, int closures) {
  if (sum.knot.n_throws < 2) return {};
  KnotOptions options;
  options.closures = closures;
  options.shape = false;
  const std::vector<double> held = held_ways(o, sum);
  for (std::size_t k = 2; k < held.size(); ++k) {
    const auto way = std::lower_bound(o.arc.begin(), o.arc.begin() + o.n_nodes, held[k]);
    const ThreadPart part{piece.first, static_cast<int>(way - o.arc.begin()) - 1};
    if (part.nodes() >= 4 && rest_of_sum(sum.knot, look_at(o, part, options))) return part;
  }
  return {};
}

/// The knot of a piece, or of one that is tied twice its last knot, then its first. The ends are those of the piece for both.
void find_knots(const Observation& o, const ThreadPart& piece, int closures, bool cut_in_front, std::vector<StitchKnot>& knots) {
  StitchKnot last = knot_in_piece(o, piece, closures, cut_in_front);
  StitchKnot first = knot_in_piece(o, first_tied(o, piece, last, closures), closures, cut_in_front);
  const std::optional<KnotReport> rest = rest_of_sum(last.knot, first.knot);
  if (rest) last.knot = *rest;
  knots.push_back(last);
  if (!rest) return;
  first.tail = last.tail;
  first.short_tail = last.short_tail;
  knots.push_back(first);
}

}  // namespace

StitchKnot knot_in_piece(const Observation& o, const ThreadPart& piece, int closures, bool cut_in_front) {
  StitchKnot k;
  if (piece.nodes() < 4) return k;
  KnotOptions options;
  options.closures = closures;
  k.knot = look_at(o, piece, options);
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
    find_knots(o, piece, closures, pass < whole_front.size() && whole_front[pass] == 0, knots);
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
  const auto holds = [&](const Stitch& s) {
    const double first = tissue.passes[static_cast<std::size_t>(s.first)].arc;
    const double second = tissue.passes[static_cast<std::size_t>(s.second < 0 ? s.first : s.second)].arc;
    return knot.holds(first) && knot.holds(second);
  };
  const auto in_loop = std::count_if(stitches.begin(), stitches.end(), holds);
  for (Stitch& s : stitches) {
    if (!holds(s)) continue;
    s.knot = knot.knot.knot_class;
    s.throws = knot.knot.n_throws;
    s.tail = knot.tail;
    s.short_tail = knot.short_tail;
    s.slack = (knot.loop() - way_round(knot, tissue)) / static_cast<double>(in_loop);
  }
}

}  // namespace filum
