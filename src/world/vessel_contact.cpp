#include "world/vessel_contact.h"

#include <algorithm>
#include <cmath>

namespace filum {
namespace {

constexpr double kDeepest = 30e-6;     // [m], overlap that counts: what has gone deeper comes back as gently
constexpr double kTrackReach = 0.3e-3;  // [m], of thread on either side of a track that is left alone
constexpr double kAhead = 0.1e-3;       // [m], by which a jaw may still be away at the start of a step: 50 mm/s
constexpr std::array<double, 3> kOnJaw = {0.0, 0.06, 0.15};  // places along a jaw, from its tip

Vec3 at_arc(const RodState& t, double arc) noexcept {
  const auto [edge, f] = locate_arc(t, arc);
  return (1.0 - f) * t.x.col(edge) + f * t.x.col(edge + 1);
}

bool in_track(const TrackState& tracks, double whole, double arc) noexcept {
  for (int i = 0; i < tracks.n; ++i) {
    const NeedleTrack& t = tracks.tracks[static_cast<std::size_t>(i)];
    if (t.n == 0) continue;
    const double a = whole + t.knots[0].strand, b = whole + t.knots[static_cast<std::size_t>(t.n - 1)].strand;
    if (arc > std::min(a, b) - kTrackReach && arc < std::max(a, b) + kTrackReach) return true;
  }
  return false;
}

}  // namespace

VesselContact::VesselContact(int thread_capacity) : before_(Points::Zero(3, thread_capacity)) {}

void VesselContact::hold(const VesselWall& wall, const WallState& w, const TouchState& s, const RodState& thread,
                         std::vector<RodTether>& on_thread) noexcept {
  before_.leftCols(thread.n) = thread.x.leftCols(thread.n);
  first_ = static_cast<int>(on_thread.size());
  for (int k = 0; k < s.n && on_thread.size() < on_thread.capacity(); ++k) {
    const ThreadTouch& touch = s.touches[static_cast<std::size_t>(k)];
    RodTether t;
    t.arc = touch.arc;
    t.anchor = wall.position(w, touch.at);
    t.stiffness = stiffness * touch.normal * touch.normal.transpose();
    const double depth = (t.anchor - at_arc(thread, touch.arc)).dot(touch.normal);
    if (depth > kDeepest) t.anchor -= (depth - kDeepest) * touch.normal;
    const auto [edge, f] = locate_arc(thread, touch.arc);
    const Vec3 run = thread.x.col(edge + 1) - thread.x.col(edge), flat = run - run.dot(touch.normal) * touch.normal;
    if (flat.norm() > 1e-9) {
      t.along = flat.normalized();
      t.stick = stiffness;
      t.limit = friction * touch.load;
      t.start = (at_arc(thread, touch.arc) - t.anchor).dot(t.along);
    }
    on_thread.push_back(t);
  }
}

void VesselContact::follow(VesselWall& wall, const WallState& w, TouchState& s, const TrackState& tracks, const RodState& thread,
                           const std::vector<RodTether>& on_thread) noexcept {
  const double whole = thread.arc_start + thread.rest_length.head(thread.n - 1).sum();
  int kept = 0;
  for (int k = 0; k < s.n; ++k) {
    const auto index = static_cast<std::size_t>(first_ + k);
    if (index >= on_thread.size()) break;
    ThreadTouch touch = s.touches[static_cast<std::size_t>(k)];
    const RodTether& t = on_thread[index];
    touch.load = t.force.dot(touch.normal);
    if (touch.load <= 0.0 || in_track(tracks, whole, touch.arc)) continue;  // outside again
    load_wall(wall, w, touch.at, t, wall.options().dt);
    const Vec3 x = at_arc(thread, touch.arc);
    const WallCrossing near = wall.nearest(w, x, 0.1e-3);
    if (near.found && near.normal.dot(touch.normal) > 0.3) {  // slides along the same side
      touch.at = near.point;
      touch.normal = near.normal;
    }
    s.touches[static_cast<std::size_t>(kept++)] = touch;
  }
  s.n = kept;
  double arc = thread.arc_start;
  for (int i = 0; i + 1 < thread.n; arc += thread.rest_length[i++]) {
    look(wall, w, s, tracks, whole, arc, before_.col(i), thread.x.col(i));
    look(wall, w, s, tracks, whole, arc + 0.5 * thread.rest_length[i], 0.5 * (before_.col(i) + before_.col(i + 1)), 0.5 * (thread.x.col(i) + thread.x.col(i + 1)));
  }
}

void VesselContact::look(const VesselWall& wall, const WallState& w, TouchState& s, const TrackState& tracks, double whole, double arc,
                         const Vec3& before, const Vec3& now) const noexcept {
  if (s.n == kMostTouches) return;
  const WallCrossing c = wall.crossing(w, before, now);
  if (!c.found || (now - before).dot(c.normal) >= 0.0 || in_track(tracks, whole, arc)) return;
  for (int k = 0; k < s.n; ++k)
    if (std::abs(s.touches[static_cast<std::size_t>(k)].arc - arc) < 20e-6) return;
  ThreadTouch touch;
  touch.arc = arc;
  touch.at = c.point;
  touch.normal = c.normal;
  s.touches[static_cast<std::size_t>(s.n++)] = touch;
}

void VesselContact::press(VesselWall& wall, const WallState& w, const std::vector<InstrumentParameters>& tools,
                          const std::vector<InstrumentState>& states) noexcept {
  n_pushes_ = 0;
  for (std::size_t i = 0; i < tools.size(); ++i) {
    const InstrumentBars bars = instrument_bars(tools[i], states[i].angle, 0.0);
    for (int b = 0; b < 2; ++b) {
      for (const double f : kOnJaw) {
        const Vec3 q = states[i].X_WT * (bars.a_T[b] + f * (bars.b_T[b] - bars.a_T[b]));
        const double radius = bars.r_a[b] + f * (bars.r_b[b] - bars.r_a[b]);
        std::array<WallCrossing, 12> places;
        const int n = wall.around(w, q, radius + kAhead, places.data(), static_cast<int>(places.size()));
        for (int k = 0; k < n && static_cast<std::size_t>(n_pushes_) < pushes_.size(); ++k) {
          const WallCrossing& near = places[static_cast<std::size_t>(k)];
          const Vec3 way = q - wall.position(w, near.point);  // at a rim or a ridge not the normal of either face
          const Vec3 normal = near.fraction > 1e-9 ? Vec3(way / near.fraction) : near.normal;
          const Vec3 lever = q - states[i].X_WT.p, carried = wall.options().dt * (states[i].v + states[i].w.cross(lever));
          const int number = wall.add_push(w, near.point, normal, radius - near.fraction, stiffness, jaw_friction, carried);
          pushes_[static_cast<std::size_t>(n_pushes_++)] = {number, static_cast<int>(i), lever};
        }
      }
    }
  }
}

void VesselContact::feel(const VesselWall& wall, std::vector<Vec3>& force, std::vector<Vec3>& torque) const noexcept {
  for (int k = 0; k < n_pushes_; ++k) {
    const Push& p = pushes_[static_cast<std::size_t>(k)];
    const Vec3 f = -wall.push(p.number);
    force[static_cast<std::size_t>(p.tool)] += f;
    torque[static_cast<std::size_t>(p.tool)] += p.lever.cross(f);
  }
}

}  // namespace filum
