#include "world/track_reach.h"

#include <algorithm>
#include <limits>

#include "physics/rod_pieces.h"

namespace filum {

TrackReaches::TrackReaches(const TrackState& tracks, const RodState& thread, double beside) noexcept {
  const double whole = arc_of_end(thread);
  for (int i = 0; i < tracks.n; ++i) {
    const NeedleTrack& t = tracks.tracks[static_cast<std::size_t>(i)];
    if (t.n == 0) continue;
    const auto [low, high] = std::minmax(t.knots[0], t.knots[static_cast<std::size_t>(t.n - 1)], [](const TrackKnot& a, const TrackKnot& b) { return a.strand < b.strand; });
    reaches_[n_++] = {whole + low.strand - beside, whole + high.strand + beside, low.at, high.at};
  }
}

const TrackReach* TrackReaches::at(double arc) const noexcept {
  for (std::size_t i = 0; i < n_; ++i)
    if (arc >= reaches_[i].from && arc < reaches_[i].to) return &reaches_[i];
  return nullptr;
}

double TrackReaches::next(double arc) const noexcept {
  double next = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < n_; ++i)
    if (reaches_[i].from > arc) next = std::min(next, reaches_[i].from);
  return next;
}

bool TrackReaches::hold_all(double arc, double length, int n) const noexcept {
  for (int k = 0; k < n; ++k)
    if (!hold(sample(arc, length, k, n))) return false;
  return true;
}

}  // namespace filum
