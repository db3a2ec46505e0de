#include "world/stray_thread.h"

#include <algorithm>
#include <cmath>

#include "base/stage_clock.h"
#include "physics/rod_pieces.h"
#include "physics/thread_grasp.h"

namespace filum {
namespace {

constexpr int kEvery = 5;                        // steps between two looks: 10 ms
constexpr double kBeside = kTrackReach + 0.1e-3; // [m], of a track: a tight stitch that is pulled lies a little farther in
constexpr double kSwage = 0.3e-3;                // [m], of thread that goes where the needle takes it
constexpr double kSamePlace = 0.2e-3;            // [m], by which a place may have gone between two looks
constexpr double kSpacing = 50e-6;               // [m], of samples along a stretch; less where less counts as deep, or the middle of a wall would be missed
constexpr double kReach = 0.3e-3;                // [m], in which the nearest surface is looked for
constexpr double kDrawn = 0.12e-3;               // [m], of thread on either side of a touch that comes along with it
constexpr double kShare = 0.5;                   // of a place's depth that the touch has which draws it
constexpr double kJustPast = 1e-9;               // [1], of an edge, after a crossing

Vec3 out_of(const VesselWall& wall, const WallState& w, const WallPoint& mouth) noexcept { return wall.nearest(w, wall.position(w, mouth), kReach).normal; }

}  // namespace

int StrayThread::step(const VesselWall& wall, const WallState& w, const TrackState& tracks, const RodState& thread, StrayState& strays, TouchState& s) noexcept {
  given_ = 0;
  if (++strays.unseen < kEvery) return 0;
  const StageScope stage("stray thread");
  now_.n = 0;
  look({wall, w, thread, strays, arc_of_end(thread)}, tracks, s);
  strays = now_;
  return given_;
}

/// Along the thread, up to where the needle takes it along.
void StrayThread::look(const Scene& c, const TrackState& tracks, TouchState& s) noexcept {
  const RodState& thread = c.thread;
  const TrackReaches reaches(tracks, thread, kBeside);
  const TrackReach* held = nullptr;  // by which the walk has just come
  bool begins = true;                // a piece
  const double last = c.whole - kSwage;
  in_.reset();
  double arc = thread.arc_start;
  for (int i = 0; i + 1 < thread.n && arc < last; arc += thread.rest_length[i++]) {
    const double end = std::min(last, arc + thread.rest_length[i]);
    if (thread.alive[i] == 0) {
      leave(c, {arc, Vec3::Zero()}, s);
      held = nullptr;
      begins = true;
      continue;
    }
    for (double at = arc; at < end;) {
      if (const TrackReach* reach = reaches.at(at)) {
        if (in_) leave(c, {at, out_of(c.wall, c.w, reach->low), true}, s);
        held = reach;
        at = reach->to;
        continue;
      }
      if (held != nullptr || begins) {
        const WallCrossing near = c.wall.nearest(c.w, at_arc(thread, at), kReach);
        if (near.found && near.fraction < 0.0) in_ = {at, held != nullptr ? out_of(c.wall, c.w, held->high) : Vec3::Zero(), held != nullptr};
        held = nullptr;
        begins = false;
      }
      const double to = std::min(end, reaches.next(at));
      pass(c, i, arc, at, to, s);
      at = to;
    }
  }
  leave(c, {std::min(arc, last), Vec3::Zero()}, s);
}

/// Along an edge that begins at `arc`, between two places that no track holds.
void StrayThread::pass(const Scene& c, int edge, double arc, double from, double to, TouchState& s) noexcept {
  const Vec3 a = c.thread.x.col(edge), b = c.thread.x.col(edge + 1);
  const double length = c.thread.rest_length[edge], until = (to - arc) / length;
  for (WallCrossing hit = c.wall.crossing(c.w, a, b, (from - arc) / length, until); hit.found; hit = c.wall.crossing(c.w, a, b, hit.fraction + kJustPast, until)) {
    const End here{arc + hit.fraction * length, hit.normal};
    if ((b - a).dot(hit.normal) > 0.0)
      leave(c, here, s);
    else if (!in_)
      in_ = here;
  }
}

/// The stretch ends, if the walk was in one.
void StrayThread::leave(const Scene& c, const End& end, TouchState& s) noexcept {
  if (!in_) return;
  const End from = *in_;
  in_.reset();
  if (!lies_deep(c, from.arc, end.arc)) return;
  for (int k = 0; k < s.n; ++k) {
    const SurfaceTouch& touch = s.touches[static_cast<std::size_t>(k)];
    below_[static_cast<std::size_t>(k)] = (c.wall.on_triangle(c.w, touch.at) - at_arc(c.thread, touch.arc)).dot(touch.normal);
  }
  const auto stray = std::find_if(samples().begin(), samples().end(), [&](const Sample& q) { return q.depth > deep_ && !drawn(q, s); });
  if (stray == samples().end()) return;
  if (now_.n < kMostStrays) now_.places[static_cast<std::size_t>(now_.n++)] = {c.whole - stray->arc, stray->x};
  if (std::none_of(stray, samples().end(), [&](const Sample& q) { return was_seen(c, q); })) return;
  const Vec3 way = way_out(from, end, s);
  if (way != Vec3::Zero()) draw(c, way, s);
}

bool StrayThread::lies_deep(const Scene& c, double from, double to) noexcept {
  n_ = 0;
  if (to - from < 2.0 * deep_) return false;  // no place of it is farther from both its ends
  const double n = std::min(std::ceil((to - from) / std::min(kSpacing, deep_)), static_cast<double>(kMostSamples));
  double deepest = 0.0;
  while (static_cast<double>(n_) < n) {
    Sample& q = samples_[n_];
    q.arc = from + (static_cast<double>(n_++) + 0.5) / n * (to - from);
    q.x = at_arc(c.thread, q.arc);
    q.depth = 0.0;
    if (c.wall.nearest(c.w, q.x, deep_).found) continue;  // asked first: to look farther costs more
    const WallCrossing near = c.wall.nearest(c.w, q.x, kReach);
    if (near.found && near.fraction < 0.0 && amid(c, q.x, near)) q.depth = -near.fraction;
    deepest = std::max(deepest, q.depth);
  }
  return deepest > deep_;
}

/// Does no more of the tissue lie beyond it, along the line from its nearest side, than makes that its share of the thickness? Not so where it cuts across a rim.
bool StrayThread::amid(const Scene& c, const Vec3& x, const WallCrossing& near) noexcept {
  const double beyond = (1.0 / kDeepShare - 1.0) * -near.fraction;
  return c.wall.crossing(c.w, x, x - beyond * near.away).found;
}

/// Was it there in the last look, by the thread or by the place?
bool StrayThread::was_seen(const Scene& c, const Sample& q) const noexcept {
  return std::any_of(c.before.places.begin(), c.before.places.begin() + c.before.n,
                     [&](const StrayPlace& p) { return std::abs(c.whole - q.arc - p.strand) < kSamePlace || (q.x - p.x).norm() < kSamePlace; });
}

/// Does a touch near by draw it back, and none the other way?
bool StrayThread::drawn(const Sample& q, const TouchState& s) const noexcept {
  const auto beside = [&](std::size_t k) { return std::abs(s.touches[k].arc - q.arc) <= kDrawn; };
  const auto n = static_cast<std::size_t>(s.n);
  Vec3 way = Vec3::Zero();
  double deepest = 0.0;
  for (std::size_t k = 0; k < n; ++k) {
    if (!beside(k) || below_[k] <= deepest) continue;
    deepest = below_[k];
    way = s.touches[k].normal;
  }
  for (std::size_t k = 0; k < n; ++k)
    if (beside(k) && below_[k] > 0.0 && s.touches[k].normal.dot(way) < 0.0) return false;
  return deepest >= kShare * q.depth;
}

Vec3 StrayThread::way_out(const End& from, const End& to, const TouchState& s) const noexcept {
  Vec3 way = Vec3::Zero();
  double deepest = deep_;
  for (std::size_t k = 0; k < static_cast<std::size_t>(s.n); ++k) {
    const SurfaceTouch& touch = s.touches[k];
    if (touch.arc < from.arc - kDrawn || touch.arc > to.arc + kDrawn || below_[k] <= deepest) continue;
    deepest = below_[k];
    way = touch.normal;
  }
  if (way != Vec3::Zero()) return way;
  if (from.mouth || to.mouth) return from.mouth ? from.out : to.out;
  const auto deep = std::max_element(samples().begin(), samples().end(), [](const Sample& a, const Sample& b) { return a.depth < b.depth; });
  const bool back = to.out == Vec3::Zero() || (from.out != Vec3::Zero() && deep->arc - from.arc <= to.arc - deep->arc);
  return back ? from.out : to.out;
}

/// Touches for what is deep in the stretch and has none, and an end to those that push the other way.
void StrayThread::draw(const Scene& c, const Vec3& way, TouchState& s) noexcept {
  const double from = samples().front().arc - kDrawn, to = samples().back().arc + kDrawn;
  int kept = 0;
  for (int k = 0; k < s.n; ++k) {
    const auto from_k = static_cast<std::size_t>(k), to_k = static_cast<std::size_t>(kept);
    const SurfaceTouch touch = s.touches[from_k];
    if (touch.arc > from && touch.arc < to && touch.normal.dot(way) < 0.0) continue;
    s.touches[to_k] = touch;
    below_[to_k] = below_[from_k];
    ++kept;
  }
  s.n = kept;
  for (const Sample& q : samples()) {
    const auto n = static_cast<std::size_t>(s.n);
    if (s.n == kMostTouches || q.depth <= deep_ || drawn(q, s)) continue;
    if (std::any_of(s.touches.begin(), s.touches.begin() + s.n, [&](const SurfaceTouch& t) { return std::abs(t.arc - q.arc) < kOneTouch; })) continue;
    SurfaceTouch& touch = s.touches[n];
    touch = {};
    touch.arc = q.arc;
    touch.normal = way;
    if (!stay_above(c.wall, c.w, touch, q.x)) continue;
    below_[n] = (c.wall.on_triangle(c.w, touch.at) - q.x).dot(way);
    ++s.n;
    ++given_;
  }
}

}  // namespace filum
