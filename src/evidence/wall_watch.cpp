#include "evidence/wall_watch.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "physics/rod_pieces.h"
#include "physics/thread_grasp.h"
#include "world/needle_model.h"
#include "world/vessel_model.h"
#include "world/wire_contact.h"

namespace filum {
namespace {

constexpr double kSpacing = 10e-6;    // [m], of samples: the middle of a wall of 25 um is not missed
constexpr double kTouchReach = 0.135e-3;  // [m]: touches are looked for every 0.1 mm, and none within 35 um of another
constexpr double kTouchShare = 0.5;   // of a sample's depth that the touch that draws it back has at least
constexpr double kOnePlace = 0.1e-3;  // [m], of the strand, between samples of one place
constexpr double kSamePlace = 0.2e-3;  // [m], on the strand or the wall, by which a place may have gone in a step

}  // namespace

WallWatch::WallWatch(const Model& model) {
  if (!model.vessel) return;
  thickness_ = model.vessel->thickness;
  if (model.needle) needle_ = model.needle->shape;
  wall_.emplace(model.vessel->mesh, model.vessel->layers, model.vessel->wall);
  held_.assign(model.vessel->mesh.slab.size(), 0);
  for (const int i : model.vessel->mesh.held) held_[static_cast<std::size_t>(i)] = 1;
}

void WallWatch::look(const State& s) {
  if (!wall_) return;
  wall_->refit(s.tissue.wall);
  std::swap(places_, before_);
  places_.clear();
  find_tracks(s);
  if (s.thread.n > 1) look_along_thread(s);
  if (s.has_needle != 0) look_along_needle(s);
  for (BuriedStrand& place : places_) place.steps = steps_of(s.tissue.wall, place);
}

BuriedStrand WallWatch::longest() const noexcept {
  const auto best = std::max_element(places_.begin(), places_.end(), [](const BuriedStrand& a, const BuriedStrand& b) { return a.steps < b.steps; });
  return best == places_.end() ? BuriedStrand{} : *best;
}

void WallWatch::find_tracks(const State& s) {
  whole_ = arc_of_end(s.thread);
  tracks_.clear();
  const TrackState& t = s.tissue.tracks;
  for (int i = 0; i < t.n; ++i) {
    const NeedleTrack& track = t.tracks[static_cast<std::size_t>(i)];
    if (track.n == 0) continue;
    const double a = track.knots[0].strand, b = track.knots[static_cast<std::size_t>(track.n - 1)].strand;
    const auto reach = [](double strand) { return strand > 0.0 ? kTrackReach + kTrackFades : kTrackReach; };
    const double low = std::min(a, b), high = t.open == i ? needle_.length() : std::max(a, b);
    tracks_.push_back({low - reach(low), high + reach(high)});
  }
}

bool WallWatch::in_track(double strand) const noexcept {
  return std::any_of(tracks_.begin(), tracks_.end(), [&](const Stretch& t) { return strand > t.from && strand < t.to; });
}

void WallWatch::look_along_thread(const State& s) {
  const RodState& t = s.thread;
  double arc = t.arc_start;
  for (int i = 0; i + 1 < t.n; arc += t.rest_length[i++]) {
    const Vec3 a = t.x.col(i), b = t.x.col(i + 1);
    if (t.alive[i] == 0 || !wall_->near(a.cwiseMin(b), a.cwiseMax(b))) continue;
    const double from = arc - whole_, length = t.rest_length[i];
    walk(s, from, from + length, [&](double strand) -> Vec3 { return a + (strand - from) / length * (b - a); });
  }
}

void WallWatch::look_along_needle(const State& s) {
  walk(s, 0.0, needle_.length(), [&](double strand) { return s.needle.X_WN * needle_.point(strand); });
}

/// Samples of the strand, farther apart where the tissue is farther off.
template <class At>
void WallWatch::walk(const State& s, double from, double to, const At& at) {
  const double reach = 2.0 * thickness_;
  double step = kSpacing;
  for (double strand = from; strand < to; strand += step) {
    const Vec3 x = at(strand);
    const WallCrossing near = wall_->nearest(s.tissue.wall, x, reach);
    step = std::max(kSpacing, near.found ? near.fraction : reach);
    if (near.found && near.fraction < 0.0 && !in_track(strand)) take(s, strand, x, near);
  }
}

void WallWatch::take(const State& s, double strand, const Vec3& x, const WallCrossing& near) {
  const Triangle& face = wall_->triangles()[static_cast<std::size_t>(near.triangle)];
  if (std::any_of(face.begin(), face.end(), [&](int i) { return held_[static_cast<std::size_t>(i)] != 0; })) return;
  const BuriedStrand found{strand, -near.fraction, share_of_thickness(s.tissue.wall, x, near), near.point, 0};
  if (found.share < kDeepShare || drawn_back(s, strand, found.depth)) return;
  BuriedStrand* last = places_.empty() ? nullptr : &places_.back();
  if (last == nullptr || strand - last->strand > kOnePlace || (last->strand < 0.0) != (strand < 0.0)) {
    places_.push_back(found);
  } else if (found.share > last->share) {
    *last = found;
  }
}

/// From the nearest side over the tissue's thickness, along the line to it.
double WallWatch::share_of_thickness(const WallState& w, const Vec3& x, const WallCrossing& near) const {
  const double far = 4.0 * thickness_, depth = -near.fraction;
  const WallCrossing c = wall_->crossing(w, x, x - far * near.away);
  return depth / (depth + (c.found ? c.fraction * far : far));
}

bool WallWatch::drawn_back(const State& s, double strand, double depth) const {
  const TouchState& touches = strand < 0.0 ? s.tissue.touches : s.tissue.wire;
  Vec3 way = Vec3::Zero();  // of the deepest
  double deepest = 0.0;
  std::array<Vec3, kMostTouches> pushes;
  std::size_t n = 0;
  for (int k = 0; k < touches.n; ++k) {
    const SurfaceTouch& touch = touches.touches[static_cast<std::size_t>(k)];
    const double there = strand < 0.0 ? touch.arc - whole_ : touch.arc;
    if (std::abs(there - strand) > kTouchReach) continue;
    const Vec3 x = strand < 0.0 ? at_arc(s.thread, touch.arc) : s.needle.X_WN * needle_.point(touch.arc);
    const double below = (wall_->on_triangle(s.tissue.wall, touch.at) - x).dot(touch.normal);
    if (below > 0.0) pushes[n++] = touch.normal;
    if (below <= deepest) continue;
    deepest = below;
    way = touch.normal;
  }
  return deepest >= kTouchShare * depth && std::none_of(pushes.begin(), pushes.begin() + static_cast<std::ptrdiff_t>(n), [&](const Vec3& push) { return push.dot(way) < 0.0; });
}

int WallWatch::steps_of(const WallState& w, const BuriedStrand& place) const {
  int steps = 0;
  for (const BuriedStrand& b : before_) {
    const bool same_thing = (b.strand < 0.0) == (place.strand < 0.0);
    const bool same_strand = std::abs(b.strand - place.strand) < kSamePlace;
    const bool same_wall = (wall_->position(w, b.at) - wall_->position(w, place.at)).norm() < kSamePlace;
    if (same_thing && (same_strand || same_wall)) steps = std::max(steps, b.steps);
  }
  return steps + 1;
}

}  // namespace filum
