#include "world/vessel_contact.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "world/track_reach.h"

namespace filum {
namespace {

constexpr double kSpacing = 0.1e-3;     // [m], of samples along the thread at most: less than a wall is thick
constexpr double kBeside = 0.2e-3;      // [m], of thread on either side of what is deep that comes out with it
constexpr double kOpposite = 0.3;       // [1], cosine, of a face against the way back
constexpr double kJustAbove = 1e-6;     // [m], from where one looks
constexpr double kAhead = 0.1e-3;       // [m], by which a jaw may still be away at the start of a step: 50 mm/s
constexpr std::array<double, 3> kOnJaw = {0.0, 0.06, 0.15};  // places along a jaw, from its tip

bool parted(const RodState& t, double arc) noexcept {
  const auto [edge, f] = locate_arc(t, arc);
  return t.alive[edge] == 0 && f > 1e-6 && f < 1.0 - 1e-6;
}

bool near_one_of(std::span<const SurfaceTouch> touches, double arc) noexcept {
  return std::any_of(touches.begin(), touches.end(), [&](const SurfaceTouch& t) { return std::abs(t.arc - arc) < kOneTouch; });
}
bool near_one_of(std::span<const double> arcs, double arc) noexcept {
  return std::any_of(arcs.begin(), arcs.end(), [&](double a) { return std::abs(a - arc) < kOneTouch; });
}

}  // namespace

VesselContact::VesselContact(int thread_capacity) : before_(Points::Zero(3, thread_capacity)) {}

void VesselContact::hold(const VesselWall& wall, const WallState& w, const TouchState& s, const RodState& thread,
                         std::vector<RodTether>& on_thread) noexcept {
  before_.leftCols(thread.n) = thread.x.leftCols(thread.n);
  first_ = static_cast<int>(on_thread.size());
  for (int k = 0; k < s.n && on_thread.size() < on_thread.capacity(); ++k) {
    const SurfaceTouch& touch = s.touches[static_cast<std::size_t>(k)];
    on_thread.push_back(hold_touch(wall, w, touch, law, at_arc(thread, touch.arc)));
  }
  n_deep_ = 0;
  note_deep(wall, w, s, thread);
}

bool VesselContact::catches(const VesselWall& wall, const WallState& w, TouchState& s, const TrackState& tracks, const RodState& thread,
                            std::vector<RodTether>& on_thread) const noexcept {
  const int known = s.n;
  sweep(wall, w, s, tracks, thread, kThrough);
  for (int k = known; k < s.n && on_thread.size() < on_thread.capacity(); ++k) {
    const SurfaceTouch& touch = s.touches[static_cast<std::size_t>(k)];
    on_thread.push_back(hold_touch(wall, w, touch, law, was_at(thread, touch.arc)));
  }
  return s.n > known;
}

Vec3 VesselContact::was_at(const RodState& thread, double arc) const noexcept {
  const auto [edge, f] = locate_arc(thread, arc);
  return (1.0 - f) * before_.col(edge) + f * before_.col(edge + 1);
}

double VesselContact::sinks(const VesselWall& wall, const WallState& w, const TouchState& s, const RodState& thread) const noexcept {
  double most = 0.0;
  for (int k = 0; k < s.n; ++k) {
    const SurfaceTouch& touch = s.touches[static_cast<std::size_t>(k)];
    most = std::max(most, sinks_past(wall, w, touch, was_at(thread, touch.arc), at_arc(thread, touch.arc)));
  }
  return most;
}

void VesselContact::follow(VesselWall& wall, const WallState& w, TouchState& s, const TrackState& tracks, const RodState& thread,
                           const std::vector<RodTether>& on_thread) noexcept {
  const TrackReaches in_tracks(tracks, thread);
  int kept = 0;
  n_come_out_ = 0;
  for (int k = 0; k < s.n; ++k) {
    const auto index = static_cast<std::size_t>(first_ + k);
    if (index >= on_thread.size()) break;
    SurfaceTouch touch = s.touches[static_cast<std::size_t>(k)];
    const RodTether& t = on_thread[index];
    touch.load = std::max(0.0, t.force.dot(touch.normal));
    if (in_tracks.hold(touch.arc) || parted(thread, touch.arc)) continue;
    const Vec3 x = at_arc(thread, touch.arc);
    const TouchFooting footing = find_footing(wall, w, touch, t, law, x);
    const bool above = footing.slides || stay_above(wall, w, touch, x);
    if (footing.off || (footing.deep && !above)) {
      come_out_[static_cast<std::size_t>(n_come_out_++)] = touch.arc;
      continue;
    }
    lean_touch(wall, w, touch, t, law);
    slide_touch(touch, footing);
    s.touches[static_cast<std::size_t>(kept++)] = touch;
  }
  s.n = kept;
  note_deep(wall, w, s, thread);
  sweep(wall, w, s, tracks, thread, 0.0);
  n_come_out_ = 0;
}

void VesselContact::overtake(const VesselWall& wall, const WallState& w, TouchState& s, const TrackState& tracks, const RodState& thread) noexcept {
  const double farthest = wall.options().dt * w.v.colwise().norm().maxCoeff();
  if (farthest == 0.0) return;
  before_.leftCols(thread.n) = thread.x.leftCols(thread.n);
  for (int k = 0; k < s.n; ++k) {
    SurfaceTouch& t = s.touches[static_cast<std::size_t>(k)];
    if (is_deep(wall, w, t, law, at_arc(thread, t.arc))) turn_touch(wall, w, t);
  }
  note_deep(wall, w, s, thread);
  for_free_samples(wall, s, tracks, thread, 2.0 * farthest, [&](double arc, const Vec3&, const Vec3& x) { touch(s, arc, passed(wall, w, x, farthest)); });
}

/// Samples on their way from before_ to where they are, past a wall that stands; `least` [m], past the surface, that counts.
void VesselContact::sweep(const VesselWall& wall, const WallState& w, TouchState& s, const TrackState& tracks, const RodState& thread, double least) const noexcept {
  for_free_samples(wall, s, tracks, thread, 0.0, [&](double arc, const Vec3& before, const Vec3& now) {
    const WallCrossing c = meet_surface(wall, w, before, now);
    if (c.found && (1.0 - c.fraction) * (before - now).dot(c.normal) >= least) touch(s, arc, c);
  });
}

/// Has the wall, in its last step, gone over a place x? It was seen from the surface's place that was nearest to it; on an edge that is a ridge,
/// and the normal of any side there leads out.
WallCrossing VesselContact::passed(const VesselWall& wall, const WallState& w, const Vec3& x, double farthest) noexcept {
  const WallCrossing was = wall.nearest_before(w, x, farthest, farthest);
  if (!was.found || was.fraction < 0.0) return {};
  return meet_surface(wall, w, wall.on_triangle(w, was.point) + kJustAbove * wall.side_normals(w, was.point).now, x);
}

template <class Look>
void VesselContact::for_free_samples(const VesselWall& wall, const TouchState& s, const TrackState& tracks, const RodState& thread, double beside,
                                     const Look& look) const noexcept {
  const TrackReaches in_tracks(tracks, thread);
  double arc = thread.arc_start;
  for (int i = 0; i + 1 < thread.n && s.n < kMostTouches; arc += thread.rest_length[i++]) {
    const int n = thread.alive[i] == 0 ? 1 : static_cast<int>(std::ceil(thread.rest_length[i] / kSpacing));
    if (in_tracks.hold_all(arc, thread.rest_length[i], n)) continue;
    const Vec3 a = before_.col(i), b = before_.col(i + 1), to_a = thread.x.col(i), to_b = thread.x.col(i + 1), around = Vec3::Constant(beside);
    if (!wall.near(a.cwiseMin(b).cwiseMin(to_a).cwiseMin(to_b) - around, a.cwiseMax(b).cwiseMax(to_a).cwiseMax(to_b) + around)) continue;
    for (int k = 0; k < n; ++k) {
      const double f = static_cast<double>(k) / n, at = TrackReaches::sample(arc, thread.rest_length[i], k, n);
      if (!in_tracks.hold(at) && !spoken_for(s, at)) look(at, (1.0 - f) * a + f * b, (1.0 - f) * to_a + f * to_b);  // asked first: the wall's search costs most
    }
  }
}

/// Has the thread a touch there already, or one that ends in this step?
bool VesselContact::spoken_for(const TouchState& s, double arc) const noexcept {
  return near_one_of(std::span(s.touches.data(), static_cast<std::size_t>(s.n)), arc) ||
         near_one_of(std::span(come_out_.data(), static_cast<std::size_t>(n_come_out_)), arc);
}

void VesselContact::touch(TouchState& s, double arc, const WallCrossing& c) const noexcept {
  if (!c.found || s.n == kMostTouches || goes_back(arc, c.normal)) return;
  SurfaceTouch& t = s.touches[static_cast<std::size_t>(s.n++)];
  t = {};
  t.arc = arc;
  t.at = c.point;
  t.normal = c.normal;
}

void VesselContact::note_deep(const VesselWall& wall, const WallState& w, const TouchState& s, const RodState& thread) noexcept {
  for (int k = 0; k < s.n && static_cast<std::size_t>(n_deep_) < deep_.size(); ++k) {
    const SurfaceTouch& touch = s.touches[static_cast<std::size_t>(k)];
    if (is_deep(wall, w, touch, law, at_arc(thread, touch.arc))) deep_[static_cast<std::size_t>(n_deep_++)] = {touch.arc, touch.normal};
  }
}

/// Would a touch there hold back what is on its way out?
bool VesselContact::goes_back(double arc, const Vec3& normal) const noexcept {
  return std::any_of(deep_.begin(), deep_.begin() + n_deep_, [&](const Deep& d) { return std::abs(d.arc - arc) < kBeside && d.way.dot(normal) < -kOpposite; });
}

double VesselContact::free_way(const VesselWall& wall, const WallState& w, const InstrumentParameters& tool, const Pose& from,
                               const InstrumentState& to) const noexcept {
  double share = 1.0;
  const InstrumentBars bars = instrument_bars(tool, to.angle, 0.0);
  for (int b = 0; b < 2; ++b) {
    for (const double f : kOnJaw) {
      const Vec3 q = bars.a_T[b] + f * (bars.b_T[b] - bars.a_T[b]), a = from * q, way = to.X_WT * q - a;
      const double radius = bars.r_a[b] + f * (bars.r_b[b] - bars.r_a[b]), length = way.norm();
      if (length <= kAhead) continue;  // press() sees it in time
      const WallCrossing hit = wall.crossing(w, a, a + (1.0 + radius / length) * way);
      if (!hit.found || hit.normal.dot(way) >= 0.0) continue;
      const double touches = hit.fraction * (length + radius) - radius;  // [m], on its way
      share = std::min(share, (std::max(0.0, touches) + kAhead) / length);
    }
  }
  return share;
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
        std::array<WallCrossing, kMostPlaces> places;
        const int n = wall.around(w, q, radius + kAhead, places.data(), static_cast<int>(places.size()));
        for (int k = 0; k < n && static_cast<std::size_t>(n_pushes_) < pushes_.size(); ++k) {
          const Vec3 lever = q - states[i].X_WT.p, carried = wall.options().dt * (states[i].v + states[i].w.cross(lever));
          const int number = wall.add_ball(w, places[static_cast<std::size_t>(k)], q, radius, law.stiffness, jaw_friction, carried);
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
