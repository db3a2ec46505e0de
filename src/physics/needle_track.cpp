#include "physics/needle_track.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "physics/rod_pieces.h"
#include "physics/thread_grasp.h"

namespace filum {
namespace {

constexpr double kPointGrip = 1.0;  // [-], friction of the point where it rests: it digs in
constexpr double kBack = 0.1e-6;      // [m], by which the point must leave the next layer to be off it: less is the wall's own trembling
constexpr double kBeside = 0.1e-3;    // [m], a free point's reach: no wall moves as far in a step
constexpr double kLift = 1e-6;        // [m], by which a point that is let go stands off the surface at least
constexpr double kStraightFrom = 2.0;  // of `stiffens`
constexpr double kDrawnBack = 20e-6;  // [m], by which the point must be behind a knot to have left it

/// Whether a piece of the thread ends in this stretch of it [m]: where it begins, or where it has parted.
bool ends_within(const RodState& t, double low, double high) noexcept {
  double arc = t.arc_start;
  if (low <= arc) return true;
  for (int j = 0; j + 1 < t.n && arc < high; arc += t.rest_length[j++])
    if (t.alive[j] == 0 && arc + t.rest_length[j] > low) return true;
  return false;
}

/// What runs through a track has no room to turn back in it: where friction has drawn it farther at one knot than at the next, both hold the place in between
/// (least squares under an order; pool adjacent violators: Ayer et al., Ann. Math. Stat. 26:641, 1955).
void keep_order(NeedleTrack& track) noexcept {
  struct Pool {
    double mean;  // [m], strand
    int size;
  };
  std::array<Pool, kTrackKnots> pools;
  std::size_t n = 0;
  const std::span knots(track.knots.data(), static_cast<std::size_t>(track.n));
  for (const TrackKnot& knot : knots) {
    pools[n++] = {knot.strand, 1};
    for (; n > 1 && pools[n - 2].mean > pools[n - 1].mean; --n) {
      const Pool a = pools[n - 2], b = pools[n - 1];
      pools[n - 2] = {(a.size * a.mean + b.size * b.mean) / (a.size + b.size), a.size + b.size};
    }
  }
  std::size_t k = 0;
  for (std::size_t p = 0; p < n; ++p)
    for (int i = 0; i < pools[p].size; ++i) knots[k++].strand = pools[p].mean;
}

/// Unit, of a strand at a place along it: an edge's own in its middle, between those of both edges at a node. A ring over which a bend is drawn sees it turn, not leap.
Vec3 direction_at(const RodState& t, int edge, double f) noexcept {
  const auto of = [&](int i) -> Vec3 { return (t.x.col(i + 1) - t.x.col(i)).normalized(); };
  const int beyond = f < 0.5 ? edge - 1 : edge + 1;
  if (beyond < 0 || beyond + 1 >= t.n || t.alive[beyond] == 0 || t.alive[edge] == 0) return of(edge);
  const double share = std::abs(f - 0.5);
  return ((1.0 - share) * of(edge) + share * of(beyond)).normalized();
}

}  // namespace

KnotHold knot_hold(const TrackMaterial& m, double give) noexcept {
  if (m.stiffens == 0.0) return {m.hold * give, m.hold};
  const double d = std::min(give, kStraightFrom * m.stiffens), q = d * d / (m.stiffens * m.stiffens), slope = m.hold * (1.0 + 3.0 * q);
  return {m.hold * (1.0 + q) * d + slope * (give - d), slope};
}

void load_wall(VesselWall& wall, const WallState& w, const WallPoint& at, const RodTether& t, double dt) noexcept {
  WallSlip slip;
  if (t.across != Vec3::Zero()) {  // on a surface it rubs the way it slips
    const Vec3 rub = t.force.dot(t.along) * t.along + t.force.dot(t.across) * t.across;
    slip.along = rub.norm() > 0.0 ? Vec3(-rub.normalized()) : t.along;
    slip.stick = t.stick;
    slip.high = t.limit;
    slip.low = -t.limit;
    slip.force = std::min(rub.norm(), t.limit);
    wall.add_load(w, at, -t.force - slip.force * slip.along, t.stiffness, slip);
    return;
  }
  slip.along = t.along;
  slip.stick = t.stick;
  slip.high = t.limit;
  slip.low = t.one_way ? 0.0 : -t.limit;
  slip.force = t.slid != 0.0 ? std::copysign(t.limit, t.slid) : std::clamp(-t.force.dot(t.along), slip.low, slip.high);
  wall.add_load(w, at, -t.force - slip.force * t.along, t.stiffness + t.drag / dt * t.along * t.along.transpose(), slip);
}

NeedleTracks::NeedleTracks(TrackMaterial material, const NeedleShape& needle, const VesselWall& wall)
    : material_(std::move(material)), needle_(needle), walk_(wall) {
  uses_.reserve(kMaxTracks * kTrackKnots);
}

RodTether NeedleTracks::tether_of(const VesselWall& wall, const WallState& w, const TrackKnot& k, double arc, const Vec3& along, const Vec3& x,
                                  double share) const noexcept {
  const PunctureLayer& l = layer(wall.layer_at(k.at));
  RodTether t;
  t.arc = arc;
  t.anchor = wall.position(w, k.at);
  t.along = along;
  t.stiffness = material_.hold * (Mat3::Identity() - along * along.transpose());
  t.stick = material_.hold;
  t.limit = share * l.friction * k.span + material_.bend_friction * k.lateral;
  t.drag = share * l.drag * k.span;
  t.start = (x - t.anchor).dot(along);
  if (material_.stiffens > 0.0) draw_aside(t, x);
  return t;
}

/// The tangent of the hold about where the strand is.
void NeedleTracks::draw_aside(RodTether& t, const Vec3& x) const noexcept {
  const Vec3 aside = x - t.anchor - t.start * t.along;
  const double give = aside.norm();
  if (give == 0.0) return;
  const KnotHold h = knot_hold(material_, give);
  const Vec3 way = aside / give;
  const double beside = h.force / give;  // [N/m], across the way that it gives
  t.stiffness = beside * (Mat3::Identity() - t.along * t.along.transpose()) + (h.slope - beside) * way * way.transpose();
  t.anchor += (give - h.force / h.slope) * way;
}

void NeedleTracks::hold(const VesselWall& wall, const WallState& w, const TrackState& s, const Pose& X_WN, const RodState* thread,
                        std::vector<RodTether>& on_needle, std::vector<RodTether>& on_thread) noexcept {
  uses_.clear();
  const double whole = thread != nullptr ? arc_of_end(*thread) : 0.0;
  for (int i = 0; i < s.n; ++i) {
    const NeedleTrack& track = s.tracks[static_cast<std::size_t>(i)];
    for (int k = 0; k < track.n; ++k) {
      const TrackKnot& knot = track.knots[static_cast<std::size_t>(k)];
      if (knot.strand >= 0.0) {
        if (on_needle.size() == on_needle.capacity()) continue;
        uses_.push_back({i, k, static_cast<int>(on_needle.size()), true, knot.strand});
        const Vec3 along = X_WN.q * needle_.tangent(knot.strand);
        on_needle.push_back(tether_of(wall, w, knot, knot.strand, along, X_WN * needle_.point(knot.strand), 1.0));
      } else if (thread != nullptr && on_thread.size() < on_thread.capacity()) {
        const auto [edge, f] = locate_arc(*thread, whole + knot.strand);
        const Vec3 a = thread->x.col(edge), b = thread->x.col(edge + 1);
        uses_.push_back({i, k, static_cast<int>(on_thread.size()), false, knot.strand});
        on_thread.push_back(tether_of(wall, w, knot, whole + knot.strand, direction_at(*thread, edge, f), (1.0 - f) * a + f * b, material_.thread_share));
      }
    }
  }
  hold_point(wall, w, s, X_WN, on_needle);
}

void NeedleTracks::hold_point(const VesselWall& wall, const WallState& w, const TrackState& s, const Pose& X_WN,
                              std::vector<RodTether>& on_needle) noexcept {
  point_tether_ = -1;
  if (s.point.kind == PointContact::Kind::none || on_needle.size() == on_needle.capacity()) return;
  const double L = needle_.length();
  const Vec3 along = X_WN.q * needle_.tangent(L);
  RodTether t;
  t.arc = L;
  t.anchor = wall.position(w, s.point.at);
  t.along = along;
  t.start = (X_WN * needle_.point(L) - t.anchor).dot(along);
  if (s.point.kind == PointContact::Kind::outside) {
    t.stiffness = under(wall, s.point.at) * Mat3::Identity();
  } else if (s.point.kind == PointContact::Kind::boundary) {
    if (t.start > 0.0) t.stiffness = under(wall, s.point.at) * along * along.transpose();  // it only stops the point, it does not hold it back
  } else {
    const PunctureLayer& l = layer(wall.layer_at(s.point.at));
    const NeedleTrack& track = s.tracks[static_cast<std::size_t>(s.open)];
    const double ahead = std::max(0.0, L - track.knots[static_cast<std::size_t>(track.n - 1)].strand);
    t.stick = material_.point_stiffness;
    t.one_way = true;  // nothing is cut on the way back
    t.limit = l.cutting + l.friction * ahead;
    t.drag = l.drag * ahead;
  }
  point_tether_ = static_cast<int>(on_needle.size());
  on_needle.push_back(t);
}

int NeedleTracks::follow(VesselWall& wall, const WallState& w, TrackState& s, const Pose& X_WN, const RodState* thread, double dt,
                         const std::vector<RodTether>& on_needle, const std::vector<RodTether>& on_thread, TrackEvent* list, int room) noexcept {
  Events e{list, room, 0};
  load_.fill(Vec3::Zero());
  const auto tether = [&](const Use& u) -> const RodTether& { return (u.needle ? on_needle : on_thread)[static_cast<std::size_t>(u.tether)]; };
  for (const Use& u : uses_) s.tracks[static_cast<std::size_t>(u.track)].knots[static_cast<std::size_t>(u.knot)].strand -= tether(u).slid;
  for (int i = 0; i < s.n; ++i) keep_order(s.tracks[static_cast<std::size_t>(i)]);
  for (const Use& u : uses_) take_knot(wall, w, s, u, tether(u), dt);
  for (int i = 0; i < s.n; ++i) tear(wall, w, s, s.tracks[static_cast<std::size_t>(i)], load_[static_cast<std::size_t>(i)], e);
  drop_passed(s, e);
  if (thread != nullptr) drop_ended(s, *thread);
  take_point(wall, w, s, X_WN, on_needle, dt, e);
  return e.n;
}

/// The load of one knot on the tissue, and what sliding through it wears and costs.
void NeedleTracks::take_knot(VesselWall& wall, const WallState& w, TrackState& s, const Use& u, const RodTether& t, double dt) noexcept {
  NeedleTrack& track = s.tracks[static_cast<std::size_t>(u.track)];
  TrackKnot& knot = track.knots[static_cast<std::size_t>(u.knot)];
  const Vec3 load = -t.force;
  const double lengthwise = t.force.dot(t.along), slid = u.before - knot.strand;
  knot.lateral = (t.force - lengthwise * t.along).norm();
  load_wall(wall, w, knot.at, t, dt);
  track.hole = std::max(track.hole, std::max(needle_.wire_radius, track.hole) + material_.wear * knot.lateral * std::abs(slid));
  load_[static_cast<std::size_t>(u.track)] += load;
  s.dissipated += t.limit * std::abs(slid) + t.drag * slid * slid / dt;
}

/// A track that is pulled harder than its bite bears moves through the tissue until it is not.
void NeedleTracks::tear(const VesselWall& wall, const WallState& w, TrackState& s, NeedleTrack& track, const Vec3& load, Events& e) noexcept {
  const double pull = load.norm();
  track.pull = pull;
  track.peak = std::max(track.peak, pull);
  if (track.n == 0 || pull < 0.25 * material_.tear * needle_.wire_radius) return;  // any bite bears that
  double bite = walk_.bite(wall, track.knots[0].at);
  for (int k = 1; k < track.n; ++k) bite = std::min(bite, walk_.bite(wall, track.knots[static_cast<std::size_t>(k)].at));
  const double bears = material_.tear * bite;
  if (pull <= bears) return;
  if (track.torn == 0.0) e.say("tear", pull);
  const double step = std::min(0.5 * needle_.wire_radius, (pull - bears) / (knot_hold(material_, kStraightFrom * material_.stiffens).slope * track.n));
  track.torn += step;
  s.dissipated += pull * step;
  bool out = false;
  for (int k = 0; k < track.n; ++k) {
    TrackKnot& knot = track.knots[static_cast<std::size_t>(k)];
    bool inside = false;
    const WallPoint to = walk_.move(wall, w, wall.position(w, knot.at) + step * load / pull, knot.at, inside);
    out = out || (!inside && walk_.bite(wall, to) < 0.5 * needle_.wire_radius);
    knot.at = to;
  }
  if (!out) return;
  e.say("torn-out", pull);
  track.n = 0;
  track.ended = 2;
}

/// Knots that the needle's point has been drawn back through hold nothing any more.
void NeedleTracks::drop_passed(TrackState& s, Events& e) noexcept {
  const double L = needle_.length();
  for (int i = 0; i < s.n; ++i) {
    NeedleTrack& track = s.tracks[static_cast<std::size_t>(i)];
    if (track.n == 0 && s.open == i) {  // torn while the point was inside
      s.open = -1;
      s.point = {};
    }
    while (track.n > 0 && track.knots[static_cast<std::size_t>(track.n - 1)].strand > L + kDrawnBack) {
      s.point.at = track.knots[static_cast<std::size_t>(track.n - 1)].at;
      --track.n;
      track.out = 0;
      s.open = i;
      s.point.kind = PointContact::Kind::within;
      if (track.n > 0) continue;
      e.say("pulled-back", 0.0);
      track.ended = 1;
      s.open = -1;
      s.point = {};
      if (i + 1 == s.n) track = {}, --s.n;
    }
  }
}

/// Knots that an end of the thread has been drawn through, its own or that of a cut, hold nothing any more: least of all what lies beyond it.
void NeedleTracks::drop_ended(TrackState& s, const RodState& thread) noexcept {
  const double whole = arc_of_end(thread);
  for (std::size_t k = uses_.size(); k-- > 0;) {  // last first: those behind one that goes move up
    const Use& u = uses_[k];
    NeedleTrack& track = s.tracks[static_cast<std::size_t>(u.track)];
    if (u.track >= s.n || u.knot >= track.n) continue;
    const auto knot = track.knots.begin() + u.knot;
    const auto [low, high] = std::minmax(u.before, knot->strand);
    if (low >= 0.0 || !ends_within(thread, whole + low, whole + high)) continue;
    std::copy(knot + 1, track.knots.begin() + track.n, knot);
    if (--track.n == 0) track.ended = 1;
  }
}

void NeedleTracks::take_point(VesselWall& wall, const WallState& w, TrackState& s, const Pose& X_WN, const std::vector<RodTether>& on_needle,
                              double dt, Events& e) noexcept {
  const double L = needle_.length();
  const Vec3 tip = X_WN * needle_.point(L), along = X_WN.q * needle_.tangent(L);
  const Vec3 before = std::exchange(s.point_before, tip);
  s.point.force = 0.0;
  if (point_tether_ >= 0 && s.point.kind != PointContact::Kind::none) {
    const RodTether& t = on_needle[static_cast<std::size_t>(point_tether_)];
    load_wall(wall, w, s.point.at, t, dt);
    switch (s.point.kind) {
      case PointContact::Kind::outside:
        rest_on_surface(wall, w, s, t, tip, along, e);
        break;
      case PointContact::Kind::within:
        advance(wall, w, s, t, tip, along);
        break;
      case PointContact::Kind::boundary:
        break_through(wall, w, s, t, along, e);
        break;
      case PointContact::Kind::none:
        break;
    }
  } else if (s.open < 0 && s.point.kind == PointContact::Kind::none) {
    find_contact(wall, w, s, before, tip, along);
  }
}

void NeedleTracks::mark_point(const VesselWall& wall, const WallState& w, const TrackState& s) noexcept {
  near_ = false;
  if (s.open >= 0 || s.point.kind != PointContact::Kind::none) return;
  const WallCrossing c = wall.nearest(w, s.point_before, kBeside);
  near_ = c.found;
  outside_ = c.fraction >= 0.0;
  beside_ = c.point;
  if (near_) beside_W_ = wall.position(w, beside_);
}

void NeedleTracks::carry_point(const VesselWall& wall, const WallState& w, TrackState& s) const noexcept {
  if (near_) s.point_before += wall.position(w, beside_) - beside_W_;
  s.point_outside = near_ && outside_;
}

void NeedleTracks::find_contact(const VesselWall& wall, const WallState& w, TrackState& s, const Vec3& before, const Vec3& tip, const Vec3& along) noexcept {
  WallCrossing c = wall.crossing(w, before, tip);
  bool in = c.found && (tip - before).dot(c.normal) < 0.0;
  if (!c.found && s.point_outside) {  // a face that twists takes the point along as its middle goes: its triangles may come past it all the same
    c = wall.nearest(w, tip, kBeside);
    in = c.found && c.fraction < 0.0;
  }
  if (!in || along.dot(c.normal) >= 0.0) return;
  s.point.kind = PointContact::Kind::outside;
  s.point.at = c.point;
  s.point.normal = c.normal;
  s.point.threshold = layer(c.layer).puncture;
}

void NeedleTracks::rest_on_surface(VesselWall& wall, const WallState& w, TrackState& s, const RodTether& t, const Vec3& tip, const Vec3& along,
                                   Events& e) noexcept {
  const WallCrossing here = wall.nearest(w, t.anchor, 1e-4);
  if (here.found) s.point.normal = here.normal;
  const double normal = t.force.dot(s.point.normal);
  if (normal <= 0.0) {
    s.point = {};
    const WallCrossing off = wall.nearest(w, tip, kBeside);  // outside by definition: a hair within it would never be seen to come in again
    if (off.found && off.fraction < kLift) s.point_before = tip + (kLift - off.fraction) * off.normal;
    return;
  }
  s.point.force = normal;
  const double angle = std::asin(std::min(1.0, std::abs(along.dot(s.point.normal))));
  const Vec3 sideways = t.force - normal * s.point.normal;
  const bool shallow = angle < material_.least_angle;
  if (shallow || sideways.norm() > kPointGrip * normal) {  // skids
    const double give = shallow ? sideways.norm() : sideways.norm() - kPointGrip * normal;
    const Vec3 to = t.anchor - give / under(wall, s.point.at) * sideways.normalized();
    const WallCrossing next = wall.nearest(w, to, 2e-4);
    if (next.found && next.surface == here.surface) s.point.at = next.point;
    return;
  }
  if (normal < s.point.threshold || s.n == kMaxTracks) return;
  e.say("puncture", normal);
  s.dissipated += 0.5 * normal * normal / under(wall, s.point.at);
  open_track(wall, w, s, angle);
}

void NeedleTracks::open_track(const VesselWall& wall, const WallState&, TrackState& s, double angle) noexcept {
  s.open = s.n++;
  NeedleTrack& track = s.tracks[static_cast<std::size_t>(s.open)];
  track = {};
  track.part = wall.mesh().part[static_cast<std::size_t>(s.point.at.element)];
  track.entry = s.point.at;
  track.entry_angle = angle;
  track.bite_entry = walk_.bite(wall, s.point.at);
  track.hole = needle_.wire_radius;
  lay_knot(wall, s, s.point.at);
  s.point.kind = PointContact::Kind::within;
}

void NeedleTracks::lay_knot(const VesselWall& wall, TrackState& s, const WallPoint& at) noexcept {
  NeedleTrack& track = s.tracks[static_cast<std::size_t>(s.open)];
  const double depth = wall.depth_at(at);
  track.shallow = std::min(track.shallow, depth);
  track.deep = std::max(track.deep, depth);
  if (track.n == kTrackKnots) {  // of a longer way the last one moves on and stands for the rest
    TrackKnot& last = track.knots.back();
    last.at = at;
    last.span += needle_.length() - last.strand;
    last.strand = needle_.length();
    return;
  }
  TrackKnot knot;
  knot.at = at;
  knot.strand = needle_.length();
  if (track.n > 0) knot.span = needle_.length() - track.knots[static_cast<std::size_t>(track.n - 1)].strand;
  track.knots[static_cast<std::size_t>(track.n++)] = knot;
}

/// The point moves on in open tissue; it stops where another layer or the far side begins.
void NeedleTracks::advance(const VesselWall& wall, const WallState& w, TrackState& s, const RodTether& t, const Vec3& tip, const Vec3& along) noexcept {
  const double u = (tip - t.anchor).dot(along), elastic = std::clamp(u, 0.0, t.limit / t.stick);
  s.dissipated += t.limit * std::max(0.0, t.slid);
  s.point.force = -t.force.dot(along);
  bool inside = false;
  const WallPoint to = walk_.move(wall, w, tip - elastic * along, s.point.at, inside);
  const Vec3 out = wall.directions(w, to).col(2).normalized();
  if (!inside) {
    const WallCrossing c = wall.nearest(w, wall.position(w, to), 1e-4);
    if (!c.found || along.dot(c.normal) <= 0.0) return;  // still at the way in
    s.point.kind = PointContact::Kind::boundary;
    s.point.leaving = 1;
    s.point.normal = c.normal;
    s.point.threshold = material_.exit_share * layer(wall.layer_at(to)).puncture;
  } else if (wall.layer_at(to) != wall.layer_at(s.point.at)) {
    s.point.kind = PointContact::Kind::boundary;
    s.point.leaving = 0;
    s.point.normal = along.dot(out) > 0.0 ? out : Vec3(-out);
    s.point.threshold = layer(wall.layer_at(to)).puncture;
  }
  s.point.at = to;
  const NeedleTrack& track = s.tracks[static_cast<std::size_t>(s.open)];
  if (track.n == 0 || needle_.length() - track.knots[static_cast<std::size_t>(track.n - 1)].strand >= material_.spacing) lay_knot(wall, s, to);
}

void NeedleTracks::break_through(const VesselWall& wall, const WallState&, TrackState& s, const RodTether& t, const Vec3& along, Events& e) noexcept {
  const double push = -t.force.dot(along), stiffness = under(wall, s.point.at);
  if (std::min(push / stiffness, t.start) < -kBack) {
    s.point.kind = PointContact::Kind::within;
    return;
  }
  const double slope = std::min(1.0, std::abs(along.dot(s.point.normal)));
  s.point.force = push * slope;
  if (s.point.force < s.point.threshold) return;
  s.dissipated += 0.5 * push * push / stiffness;
  s.point.kind = PointContact::Kind::within;
  e.say(s.point.leaving != 0 ? "needle-out" : "puncture", s.point.force);
  if (s.point.leaving == 0) return;
  NeedleTrack& track = s.tracks[static_cast<std::size_t>(s.open)];
  lay_knot(wall, s, s.point.at);
  track.out = 1;
  track.exit = s.point.at;
  track.exit_angle = std::asin(slope);
  track.bite_exit = walk_.bite(wall, s.point.at);
  s.open = -1;
  s.point = {};
}

}  // namespace filum
