#include "world/fresh_suture.h"

#include <algorithm>

#include "collision/segment_distance.h"
#include "world/measured_model.h"
#include "world/needle_model.h"
#include "world/observe.h"

namespace filum {
namespace {

constexpr std::int32_t kFresh = 32;  // button (world/inputs.h)
constexpr double kClear = 0.1e-3;    // [m], between what is there and the new thread

bool holds(const RodState& t, const RodPiece& p, double arc) noexcept { return arc >= arc_of_node(t, p.first) && arc <= arc_of_node(t, p.last); }

bool held(const State& s, const RodPiece& p) noexcept {
  return std::any_of(s.memory.grasps.begin(), s.memory.grasps.end(), [&](const GraspPoint& g) { return holds(s.thread, p, g.arc); });
}

/// Whether one of its ways through the tissue holds this piece, or the needle.
bool in_tissue(const State& s, const RodPiece& p, bool needle) noexcept {
  const double whole = arc_of_end(s.thread);
  for (int i = 0; i < s.tissue.tracks.n; ++i) {
    const NeedleTrack& t = s.tissue.tracks.tracks[static_cast<std::size_t>(i)];
    for (int k = 0; k < t.n; ++k) {
      const double strand = t.knots[static_cast<std::size_t>(k)].strand;
      if (strand >= 0.0 ? needle : holds(s.thread, p, whole + strand)) return true;
    }
  }
  return false;
}

/// Everything that names a place of the thread by its material coordinate.
void follow(State& s, const ArcChange& c, double whole_before) noexcept {
  const double whole = arc_of_end(s.thread);
  for (int i = 0; i < s.tissue.tracks.n; ++i) {
    NeedleTrack& t = s.tissue.tracks.tracks[static_cast<std::size_t>(i)];
    for (int k = 0; k < t.n; ++k) {
      double& strand = t.knots[static_cast<std::size_t>(k)].strand;
      strand = c.after(whole_before + strand) - whole;
    }
  }
  TouchState& touches = s.tissue.touches;
  int kept = 0;
  for (int k = 0; k < touches.n; ++k) {
    SurfaceTouch touch = touches.touches[static_cast<std::size_t>(k)];
    if (c.gone(touch.arc)) continue;
    touch.arc = c.after(touch.arc);
    touches.touches[static_cast<std::size_t>(kept++)] = touch;
  }
  touches.n = kept;
  for (GraspPoint& g : s.memory.grasps) g.arc = c.after(g.arc);
  for (double* arc : {&s.cut_low, &s.cut_high, &s.break_arc}) *arc = *arc < 0.0 || c.gone(*arc) ? -1.0 : c.after(*arc);
}

}  // namespace

RodState first_thread(const Model& model) {
  RodState thread = RodState::from_nodes(model.thread_path, model.description.capacity);
  if (model.rest_curvature != 0.0) curl(thread, model.rest_curvature);
  return thread;
}

FreshSuture::FreshSuture(const Model& model) : model_(model), thread_(first_thread(model)) {
  const NeedleShape& n = model.needle->shape;
  for (std::size_t k = 0; k < wire_.size(); ++k)
    wire_[k] = model.needle->start * n.point(n.length() * static_cast<double>(k) / static_cast<double>(wire_.size() - 1));
}

bool FreshSuture::touches_path(const Vec3& a, const Vec3& b, double room) const noexcept {
  for (int j = 0; j + 1 < thread_.n; ++j)
    if (closest_points(a, b, thread_.x.col(j), thread_.x.col(j + 1)).distance < room) return true;
  for (std::size_t k = 0; k + 1 < wire_.size(); ++k)
    if (closest_points(a, b, wire_[k], wire_[k + 1]).distance < room) return true;
  return false;
}

bool FreshSuture::in_the_way(const State& s) const noexcept {
  const double radius = model_.thread.radius;
  for (std::size_t i = 0; i < s.instruments.size(); ++i) {
    const InstrumentBars bars = instrument_bars(model_.instruments[i], s.instruments[i].angle, 2.0 * radius);
    for (std::size_t k = 0; k < 3; ++k)
      if (touches_path(s.instruments[i].X_WT * bars.a_T[k], s.instruments[i].X_WT * bars.b_T[k], std::max(bars.r_a[k], bars.r_b[k]) + radius + kClear)) return true;
  }
  const int strand = piece_to(s.thread, s.thread.n - 1).first;
  for (RodPiece p = piece_from(s.thread, 0); p.last < strand; p = piece_from(s.thread, p.last + 1)) {
    if (!held(s, p) && !in_tissue(s, p, false)) continue;  // goes with the old one
    for (int j = p.first; j < p.last; ++j)
      if (touches_path(s.thread.x.col(j), s.thread.x.col(j + 1), 2.0 * radius + kClear)) return true;
  }
  return false;
}

const char* FreshSuture::refusal(const State& s) const noexcept {
  if (s.sutures.taken >= model_.sutures) return "suture-none-left";
  const RodPiece strand = piece_to(s.thread, s.thread.n - 1);
  if (s.needle.in_hand() || held(s, strand)) return "suture-held";
  if (s.tissue.tracks.open >= 0 || in_tissue(s, strand, true)) return "suture-in-tissue";
  if (in_the_way(s)) return "suture-in-the-way";
  int kept = 0;
  for (RodPiece p = piece_from(s.thread, 0); p.last < strand.first; p = piece_from(s.thread, p.last + 1))
    if (held(s, p) || in_tissue(s, p, false)) kept += p.last + 1 - p.first;
  return kept + thread_.n > model_.description.capacity ? "suture-no-room" : nullptr;
}

/// Takes the strand on the needle away, and what lies loose.
void FreshSuture::clear(State& s) const noexcept {
  RodPiece p = piece_to(s.thread, s.thread.n - 1);
  for (bool strand = true; p.last >= 0; strand = false) {
    const int before = p.first - 1;
    if (strand || (!held(s, p) && !in_tissue(s, p, false))) {
      const double whole = arc_of_end(s.thread);
      const ArcChange c = take_out(p, s.thread, s.memory);
      follow(s, c, whole);
    }
    if (before < 0) break;
    p = piece_to(s.thread, before);
  }
}

void FreshSuture::lay(State& s) const noexcept {
  const double whole = arc_of_end(s.thread);
  join_on(thread_, s.thread);
  follow(s, {}, whole);
  const NeedleShape& n = model_.needle->shape;
  s.needle = NeedleState();
  s.needle.X_WN = model_.needle->start;
  s.tissue.wire = TouchState();
  s.tissue.tracks.point = PointContact();
  s.tissue.tracks.point_before = s.needle.X_WN * n.point(n.length());
  s.overloaded = 0.0;
}

void FreshSuture::hear(State& s, std::uint32_t buttons, Observation& o) const noexcept {
  const std::int32_t down = static_cast<std::int32_t>(buttons) & kFresh;
  const bool pressed = down != 0 && s.sutures.down == 0;
  s.sutures.down = down;
  if (!pressed) return;
  if (const char* why = refusal(s)) {
    say(o, why, -1, model_.sutures - s.sutures.taken, "-");
    return;
  }
  clear(s);
  lay(s);
  ++s.sutures.taken;
  say(o, "suture-fresh", -1, model_.sutures - s.sutures.taken, "-");
}

}  // namespace filum
