#include "world/wire_contact.h"

#include <algorithm>
#include <cmath>

namespace filum {
namespace {

constexpr double kSpacing = 0.1e-3;   // [m], of samples at most: less than a wall is thick
constexpr double kAtPoint = 0.4e-3;   // [m], before the point, that are the point's own
constexpr double kAhead = 30e-6;      // [m], by which a face may still be away at the start of its step
constexpr double kLeft = 10e-6;       // [m], by which a wire has left what it touched

}  // namespace

WireContact::WireContact(const NeedleShape& needle) : law{200.0, 0.15, needle.wire_radius}, needle_(needle) {
  const double wire = std::max(0.0, needle.length() - kAtPoint);
  n_ = std::min(kMostWireSamples, 1 + static_cast<int>(std::ceil(wire / kSpacing)));
  spacing_ = n_ > 1 ? wire / (n_ - 1) : kSpacing;
}

void WireContact::hold(const VesselWall& wall, const WallState& w, const TouchState& s, const TrackState& tracks, const Pose& X_WN, bool held,
                       std::vector<RodTether>& on_needle) noexcept {
  before_ = X_WN;
  find_shares(tracks);
  first_ = static_cast<int>(on_needle.size());
  for (int k = 0; k < s.n && on_needle.size() < on_needle.capacity(); ++k) {
    const SurfaceTouch& touch = s.touches[static_cast<std::size_t>(k)];
    const Vec3 x = X_WN * needle_.point(touch.arc);
    RodTether& t = on_needle.emplace_back(held ? felt(touch, x) : hold_touch(wall, w, touch, law, x));
    if (!held) t.stiffness *= share(touch.arc);
  }
}

/// The push of the last step; it falls as the wire gives way, and does not pull.
RodTether WireContact::felt(const SurfaceTouch& touch, const Vec3& x) const noexcept {
  RodTether t;
  t.arc = touch.arc;
  const double push = touch.push.norm();
  const Vec3 way = push > 0.0 ? Vec3(touch.push / push) : touch.normal;
  const double firm = touch.firm > 0.0 ? touch.firm : law.stiffness;
  t.anchor = x + push / firm * way;
  t.stiffness = firm * way * way.transpose();
  t.along = way.unitOrthogonal();
  t.across = way.cross(t.along);
  return t;
}

double WireContact::sinks(const VesselWall& wall, const WallState& w, const TouchState& s, const Pose& X_WN) const noexcept {
  double most = 0.0;
  for (int k = 0; k < s.n; ++k) {
    const SurfaceTouch& touch = s.touches[static_cast<std::size_t>(k)];
    const Vec3 p_N = needle_.point(touch.arc);
    most = std::max(most, sinks_past(wall, w, touch, before_ * p_N, X_WN * p_N));
  }
  return most;
}

void WireContact::find_shares(const TrackState& tracks) noexcept {
  share_.fill(1.0);
  for (int i = 0; i < tracks.n; ++i) {
    const NeedleTrack& t = tracks.tracks[static_cast<std::size_t>(i)];
    if (t.n == 0) continue;
    const double entry = t.knots[0].strand, exit = t.knots[static_cast<std::size_t>(t.n - 1)].strand;  // negative: thread
    if (entry < 0.0 && exit < 0.0) continue;
    const double from = std::min(entry, exit), to = tracks.open == i ? needle_.length() : std::max(entry, exit);
    for (int k = 0; k < n_; ++k) {
      const double away = std::max(from - k * spacing_, k * spacing_ - to);
      double& share = share_[static_cast<std::size_t>(k)];
      share = std::min(share, std::clamp((away - kTrackReach) / kTrackFades, 0.0, 1.0));
    }
  }
}

void WireContact::follow(VesselWall& wall, const WallState& w, TouchState& s, const TrackState& tracks, const Pose& X_WN, bool held,
                         const std::vector<RodTether>& on_needle) noexcept {
  find_shares(tracks);
  int kept = 0;
  n_pushes_ = 0;
  for (int k = 0; k < s.n; ++k) {
    const auto index = static_cast<std::size_t>(first_ + k);
    if (index >= on_needle.size()) break;
    SurfaceTouch touch = s.touches[static_cast<std::size_t>(k)];
    const RodTether& t = on_needle[index];
    const double there = share(touch.arc);
    share(touch.arc) = 0.0;  // nor is it looked at again below if it comes off: on its way out it passes the wall from within
    const Vec3 p_N = needle_.point(touch.arc), x = X_WN * p_N;
    const TouchFooting footing = find_footing(wall, w, touch, t, law, x);
    if (there == 0.0 || (footing.slides ? footing.near.fraction > law.radius + kLeft : footing.off)) continue;
    touch.load = std::max(0.0, t.force.dot(touch.normal));
    if (!held) {
      touch.push = t.force;
      lean_touch(wall, w, touch, t, law);
    }
    slide_touch(touch, footing);
    if (held) press(wall, w, touch, kept, footing, there * law.stiffness, x, x - before_ * p_N);
    s.touches[static_cast<std::size_t>(kept++)] = touch;
  }
  s.n = kept;
  for (int k = 0; k < n_; ++k) {
    if (share_[static_cast<std::size_t>(k)] == 0.0) continue;
    const Vec3 p_N = needle_.point(k * spacing_), before = before_ * p_N, now = X_WN * p_N;
    if (const WallCrossing c = meet_surface(wall, w, before, now); c.found) touch(s, k, c);
  }
}

void WireContact::press(VesselWall& wall, const WallState& w, const SurfaceTouch& touch, int number, const TouchFooting& footing, double stiffness,
                        const Vec3& x, const Vec3& carried) noexcept {
  const auto note = [&](int push) {
    if (static_cast<std::size_t>(n_pushes_) < pushes_.size()) pushes_[static_cast<std::size_t>(n_pushes_++)] = {push, number, stiffness};
  };
  if (!footing.slides || footing.near.fraction <= 0.0)
    return note(wall.add_push(w, touch.at, {touch.normal, std::min(kDeepest, footing.depth), stiffness, law.friction, carried}));
  std::array<WallCrossing, 12> places;
  const int n = wall.around(w, x, law.radius + kAhead, places.data(), static_cast<int>(places.size()));
  for (int k = 0; k < n; ++k) note(wall.add_ball(w, places[static_cast<std::size_t>(k)], x, law.radius, stiffness, law.friction, carried));
}

void WireContact::feel(const VesselWall& wall, TouchState& s) noexcept {
  if (n_pushes_ == 0) return;
  for (int k = 0; k < s.n; ++k) {
    s.touches[static_cast<std::size_t>(k)].push.setZero();
    s.touches[static_cast<std::size_t>(k)].firm = 0.0;
  }
  for (int k = 0; k < n_pushes_; ++k) {
    const Push& p = pushes_[static_cast<std::size_t>(k)];
    const Vec3 force = wall.push(p.number);
    if (force.isZero(0.0)) continue;
    SurfaceTouch& touch = s.touches[static_cast<std::size_t>(p.touch)];
    touch.push -= force;
    touch.firm += p.stiffness;
  }
}

void WireContact::overtake(const VesselWall& wall, const WallState& w, TouchState& s, const TrackState& tracks, const Pose& X_WN) noexcept {
  find_shares(tracks);
  for (int k = 0; k < s.n; ++k) share(s.touches[static_cast<std::size_t>(k)].arc) = 0.0;
  const double reach = std::max(law.radius, wall.options().dt * w.v.colwise().norm().maxCoeff());
  for (int k = 0; k < n_; ++k) {
    if (share_[static_cast<std::size_t>(k)] == 0.0) continue;
    const Vec3 now = X_WN * needle_.point(k * spacing_);
    const WallCrossing near = wall.nearest(w, now, reach);
    if (!near.found) continue;
    if (near.fraction >= 0.0 && near.fraction < law.radius) {
      touch(s, k, near);
    } else if (const WallCrossing c = meet_surface(wall, w, now + wall.options().dt * wall.velocity(w, near.point), now); c.found) {
      touch(s, k, c);
    }
  }
}

void WireContact::touch(TouchState& s, int sample, const WallCrossing& c) noexcept {
  if (s.n == kMostTouches) return;
  s.touches[static_cast<std::size_t>(s.n++)] = {sample * spacing_, c.point, c.normal, 0.0, Vec3::Zero(), 0.0};
}

}  // namespace filum
