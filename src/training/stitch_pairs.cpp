#include "training/stitch_pairs.h"

namespace filum {

bool is_lost(const PassObservation& p) noexcept { return p.state == PassObservation::State::pulled_out || p.state == PassObservation::State::torn; }

bool is_whole(const PassObservation& p) noexcept { return p.bite_entry * p.bite_exit < 0.0; }

void StitchPairs::observe(const TissueObservation& t) {
  const auto pass = [&](int k) -> const PassObservation& { return t.passes[static_cast<std::size_t>(k)]; };
  for (; next_ < t.n_passes; ++next_) {
    const PassObservation& p = pass(next_);
    if (is_lost(p)) continue;
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
