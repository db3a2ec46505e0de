#include "training/stitch_pairs.h"

#include <limits>

#include "training/thread_part.h"

namespace filum {
namespace {

/// On one piece of thread; what the needle is in hangs on the last piece.
bool on_one_piece(const Observation& o, const PassObservation& a, const PassObservation& b) {
  const auto first = [&](const PassObservation& p) { return piece_at(o, p.arc < 0.0 ? std::numeric_limits<double>::infinity() : p.arc).first; };
  return first(a) == first(b);
}

}  // namespace

bool is_lost(const PassObservation& p) noexcept { return p.state == PassObservation::State::pulled_out || p.state == PassObservation::State::torn; }

bool is_whole(const PassObservation& p) noexcept { return p.bite_entry * p.bite_exit < 0.0; }

void StitchPairs::observe(const Observation& o) {
  const auto pass = [&](int k) -> const PassObservation& { return o.tissue.passes[static_cast<std::size_t>(k)]; };
  for (; next_ < o.tissue.n_passes; ++next_) {
    const PassObservation& p = pass(next_);
    if (is_lost(p)) continue;
    if (half_ >= 0 && !on_one_piece(o, pass(half_), p)) half_ = -1;
    if (!p.out || p.state != PassObservation::State::thread) return;
    if (is_whole(p)) continue;
    if (half_ < 0 || is_lost(pass(half_)) || pass(half_).side == p.side) {
      half_ = next_;
      continue;
    }
    made_.push_back({half_, next_});
    half_ = -1;
  }
}

std::vector<std::array<int, 2>> StitchPairs::with_needle(const TissueObservation& t) const {
  std::vector<std::array<int, 2>> all = made_;
  if (next_ >= t.n_passes) return all;
  const int first = half_ >= 0 ? half_ : next_, second = half_ >= 0 ? next_ : next_ + 1;
  if (second >= t.n_passes) return all;
  const PassObservation &a = t.passes[static_cast<std::size_t>(first)], &b = t.passes[static_cast<std::size_t>(second)];
  if (a.out && b.out && a.side != b.side && !is_lost(a) && !is_lost(b) && !is_whole(a) && !is_whole(b)) all.push_back({first, second});
  return all;
}

}  // namespace filum
