#include "training/needle_watch.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>

#include "base/numbers.h"
#include "training/cut_line.h"
#include "training/stitch_knot.h"
#include "training/stitch_pairs.h"

namespace filum {
namespace {

constexpr double kRightAngle = 0.5 * std::numbers::pi;
constexpr double kLookEvery = 0.25;  // [s], at the thread for knots
constexpr double kSameArc = 1e-9;    // [m], of the thread: a cut at a node is told to rounding

int passes_done(const TissueObservation& t) {
  return static_cast<int>(std::count_if(t.passes.begin(), t.passes.begin() + t.n_passes, [](const PassObservation& p) {
    return p.out && p.state == PassObservation::State::thread;
  }));
}

/// [m], thread before the first way of the piece that hangs on the needle; NaN while the needle is in it.
double thread_left(const Observation& o) {
  const double start = o.n_parted == 0 ? 0.0 : o.arc[static_cast<std::size_t>(o.parted[static_cast<std::size_t>(o.n_parted - 1)] + 1)];
  for (int i = 0; i < o.tissue.n_passes; ++i) {
    const PassObservation& p = o.tissue.passes[static_cast<std::size_t>(i)];
    if (is_lost(p)) continue;
    if (p.arc < 0.0) return kNaN;
    if (p.arc >= start) return p.arc - start;
  }
  return kNaN;
}

/// [N], in the thread at its place `arc`: the larger pull of the two edges about it.
double tension_at(const Observation& o, double arc) {
  const std::size_t edges = std::min(o.tension.size(), static_cast<std::size_t>(std::max(o.n_nodes - 1, 0)));
  for (std::size_t i = 0; i < edges; ++i)
    if (o.arc[i + 1] >= arc) return std::max(o.tension[i], i + 1 < edges ? o.tension[i + 1] : 0.0);
  return kNaN;
}

void name_tension(const Observation& o, Stitch& s) {
  s.tension = kNaN;
  for (const int k : {s.first, s.second})
    if (const double arc = k < 0 ? -1.0 : o.tissue.passes[static_cast<std::size_t>(k)].arc; arc >= 0.0) s.tension = std::fmax(s.tension, tension_at(o, arc));
}

}  // namespace

double needle_value(Measure measure, const NeedleReport& r) {
  const auto worst = [&](auto value) {
    double most = kNaN;
    for (const Stitch& s : r.stitches)
      if (s.joins) most = std::fmax(most, value(s));
    return most;
  };
  switch (measure) {
    case Measure::needle_angle:
      return r.angle_error;
    case Measure::needle_share:
      return r.share;
    case Measure::needle_takes:
      return r.takes;
    case Measure::needle_drops:
      return r.drops;
    case Measure::needle_present:
      return r.present_error;
    case Measure::tissue_takes:
      return r.handling.folds + r.handling.walls;
    case Measure::wall_grasps:
      return r.handling.walls;
    case Measure::tissue_slips:
      return r.handling.slips;
    case Measure::grip_pull:
      return r.handling.pull;
    case Measure::stitch_order:
      return r.out_of_turn < 0 ? kNaN : r.out_of_turn;
    case Measure::stitches:
      return r.has_tissue ? static_cast<double>(std::count_if(r.stitches.begin(), r.stitches.end(), [](const Stitch& s) { return s.joins; })) : kNaN;
    case Measure::bite_inequality:
      return worst([](const Stitch& s) { return std::abs(s.bite[0] - s.bite[1]) / std::max(s.bite[0], s.bite[1]); });
    case Measure::bite_widest:
      return worst([&](const Stitch& s) { return std::fmax(s.bite[0], s.bite[1]) / r.thickness; });
    case Measure::entry_error:
      return worst([](const Stitch& s) { return kRightAngle - s.entry_angle; });
    case Measure::obliquity:
      return worst([](const Stitch& s) { return s.obliquity; });
    case Measure::tissue_pull:
      return r.has_tissue ? r.peak_force : kNaN;
    case Measure::lapses:
      return r.has_tissue ? static_cast<double>(r.lapses.size()) : kNaN;
    default:
      return kNaN;
  }
}

NeedleWatch::NeedleWatch(const NeedleTask& task, const SceneDescription& scene) : task_(task), scene_(scene), order_(task.goals, scene.tissue), pass_time_(kMaxPasses, 0.0), tear_time_(kMaxPasses, kNaN), whole_front_(kMaxPasses, 1) {}

bool NeedleWatch::held_only_by(const Observation& o, int tool) const {
  for (int i = 0; i < o.n_tools; ++i)
    if (o.needle.held[static_cast<std::size_t>(i)] != (i == tool)) return false;
  return true;
}

/// One way in from above and another out below it, or the first way comes out above itself: the hole that it went into and the one it came out of.
bool NeedleWatch::through_eye(const NeedleGoal& g, const TissueObservation& t) {
  const auto off = [](const Vec3& a, const Vec3& b) { return (a - b).head<2>().norm(); };
  for (int k = used_; k < t.n_passes; ++k) {
    const double in = off(t.passes[static_cast<std::size_t>(k)].entry_rest, g.at);
    if (in > g.within) continue;
    for (int j = k; j <= std::min(k + 1, t.n_passes - 1); ++j) {
      const PassObservation& last = t.passes[static_cast<std::size_t>(j)];
      const double out = off(last.exit_rest, g.out);
      if (!last.out || out > g.within) continue;
      used_ = j + 1;
      square_ += in * in + out * out;
      present_time_ += 2.0;
      return true;
    }
  }
  return false;
}

/// Where a suture begins it need not have been cut: a fresh one lies behind the pieces of those before it.
void NeedleWatch::follow_cuts(const Observation& o) {
  const auto cut_at = [&](const ThreadPart& piece, double arc) {
    const auto first = static_cast<std::size_t>(piece.first);
    return first > 0 && o.arc[first - 1] <= arc + kSameArc && arc <= o.arc[first] + kSameArc;
  };
  const ThreadPart on_needle = {o.n_parted == 0 ? 0 : o.parted[static_cast<std::size_t>(o.n_parted - 1)] + 1, o.n_nodes - 1};
  for (int k = 0; k < o.n_events; ++k) {
    const WorldEvent& e = o.events[static_cast<std::size_t>(k)];
    if (std::string_view(e.name) == "suture-fresh") whole_ = true;
    if (std::string_view(e.name) != "cut") continue;
    whole_ = whole_ && !cut_at(on_needle, e.value);
    for (int i = 0; i < o.tissue.n_passes; ++i)
      if (const double arc = o.tissue.passes[static_cast<std::size_t>(i)].arc; arc >= 0.0 && cut_at(piece_at(o, arc), e.value)) whole_front_[static_cast<std::size_t>(i)] = 0;
  }
  for (int i = 0; i < o.tissue.n_passes; ++i)
    if (o.tissue.passes[static_cast<std::size_t>(i)].arc < 0.0) whole_front_[static_cast<std::size_t>(i)] = whole_ ? 1 : 0;
}

/// The thread through the first so many ways that hold thread is cut on either side of each.
bool NeedleWatch::cut_off(const Observation& o, int passes) const {
  int cut = 0;
  for (int i = 0; i < o.tissue.n_passes && cut < passes; ++i) {
    const PassObservation& p = o.tissue.passes[static_cast<std::size_t>(i)];
    if (is_lost(p)) continue;
    if (p.arc < 0.0 || whole_front_[static_cast<std::size_t>(i)] != 0 || piece_at(o, p.arc).last == o.n_nodes - 1) return false;
    ++cut;
  }
  return cut == passes;
}

bool NeedleWatch::tied(const NeedleGoal& g, const Observation& o) {
  if (o.time < next_knot_) return tied_;
  next_knot_ = o.time + kLookEvery;
  tied_ = false;
  if (passes_done(o.tissue) < g.passes) return false;
  const std::vector<StitchKnot> knots = knots_in_tissue(o, 1);
  const auto counts = [&](const StitchKnot& k) {
    return k.knot.n_throws >= g.throws && k.loop() <= g.loop && (g.knots.empty() || std::find(g.knots.begin(), g.knots.end(), k.knot.knot_class) != g.knots.end());
  };
  const auto ties = [&](const PassObservation& p) { return std::any_of(knots.begin(), knots.end(), [&](const StitchKnot& k) { return counts(k) && k.holds(p.arc); }); };
  return tied_ = std::count_if(o.tissue.passes.begin(), o.tissue.passes.begin() + o.tissue.n_passes, ties) >= g.passes;
}

bool NeedleWatch::met(const NeedleGoal& g, const Observation& o, double dt) {
  const auto tool = static_cast<std::size_t>(g.tool);
  bool now = false;
  switch (g.kind) {
    case NeedleGoal::Kind::pick:
      return o.needle.held[tool] && o.needle.X_WN.p.z() > scene_.floor_height + 0.5e-3;
    case NeedleGoal::Kind::load: {
      const double error = kRightAngle - o.needle.grip_angle[tool], share = o.needle.grip_share[tool];
      now = held_only_by(o, g.tool) && error <= g.angle && share >= g.low && share <= g.high;
      if (!held_only_by(o, g.tool)) break;
      angle_sum_ += error * dt;
      share_sum_ += share * dt;
      angle_time_ += dt;
      break;
    }
    case NeedleGoal::Kind::present: {
      const double error = (o.needle.point_W - g.at).norm();
      now = error <= g.within;
      if (!now) break;
      square_ += error * error * dt;
      present_time_ += dt;
      break;
    }
    case NeedleGoal::Kind::grasp: {
      const GripObservation& grip = o.tissue.grips[tool];
      now = grip.held && !grip.through && grip.side == g.side && grip.pull >= g.low && grip.pull <= g.high;
      break;
    }
    case NeedleGoal::Kind::eye:
      return through_eye(g, o.tissue);
    case NeedleGoal::Kind::pass:
      return passes_done(o.tissue) >= g.passes;
    case NeedleGoal::Kind::draw:
      return passes_done(o.tissue) >= g.passes && thread_left(o) <= g.tail;
    case NeedleGoal::Kind::tie:
      now = tied(g, o);
      break;
    case NeedleGoal::Kind::cut:
      return cut_off(o, g.passes);
    case NeedleGoal::Kind::stitch:
      if (!order_.made(step_) || (g.stitch.running && o.time < next_knot_)) return false;
      next_knot_ = o.time + kLookEvery;
      return !g.stitch.running || order_.runs_on(step_, o);
  }
  kept_ = now ? kept_ + dt : 0.0;
  return now && kept_ >= g.seconds;
}

/// Before the new passes are kept: a way that was drawn back and made again counts from then.
void NeedleWatch::keep_times(const TissueObservation& t, double time) {
  for (int i = 0; i < t.n_passes; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const bool was_out = i < tissue_.n_passes && tissue_.passes[k].out;
    if (t.passes[k].out && !was_out) pass_time_[k] = time;
    if (t.passes[k].torn <= task_.lapses.tear) tear_time_[k] = kNaN;
    else if (std::isnan(tear_time_[k])) tear_time_[k] = time;
    if (!t.passes[k].out) pass_time_[k] = std::isnan(tear_time_[k]) ? 0.0 : tear_time_[k];
  }
}

void NeedleWatch::observe(const Observation& o, double dt, bool scored, std::vector<TaskEvent>& events) {
  for (int k = 0; k < o.n_events; ++k) {
    const std::string_view name = o.events[static_cast<std::size_t>(k)].name;
    report_.takes += name == "needle-taken" ? 1 : 0;
    report_.drops += name == "needle-dropped" ? 1 : 0;
    report_.handling.folds += name == "tissue-taken" ? 1 : 0;
    report_.handling.walls += name == "wall-taken" ? 1 : 0;
    report_.handling.slips += name == "tissue-slipped" ? 1 : 0;
  }
  for (const GripObservation& g : o.tissue.grips) report_.handling.pull = std::max(report_.handling.pull, g.pull);
  follow_cuts(o);
  blood_.observe(o);
  time_ = o.time;
  keep_times(o.tissue, o.time);
  tissue_.n_passes = o.tissue.n_passes;
  tissue_.soundness = o.tissue.soundness;
  for (int k = 0; k < o.tissue.n_passes; ++k) {
    const PassObservation& p = o.tissue.passes[static_cast<std::size_t>(k)];
    tissue_.passes[static_cast<std::size_t>(k)] = p;
    report_.peak_force = std::max(report_.peak_force, p.peak_force);
  }
  order_.observe(o, events);
  if (done() || !scored) return;
  if (!met(task_.goals[static_cast<std::size_t>(step_)], o, dt)) return;
  events.push_back({o.time, "goal-done", task_.goals[static_cast<std::size_t>(step_)].tool, step_ + 1.0, "-", {}});
  ++step_;
  kept_ = 0.0;
  tied_ = false;
}

NeedleReport NeedleWatch::report(const std::optional<JoinReport>& join, const Observation* last) const {
  NeedleReport r = report_;
  if (angle_time_ > 0.0) {
    r.angle_error = angle_sum_ / angle_time_;
    r.share = share_sum_ / angle_time_;
  }
  if (present_time_ > 0.0) r.present_error = std::sqrt(square_ / present_time_);
  if (std::any_of(task_.goals.begin(), task_.goals.end(), [](const NeedleGoal& g) { return g.kind == NeedleGoal::Kind::stitch; }))
    r.out_of_turn = order_.out_of_turn();
  r.has_tissue = task_.has_tissue;
  if (!r.has_tissue) return r;
  r.thickness = scene_.tissue.thickness;
  if (scene_.tissue.lumen) r.round = 2.0 * std::numbers::pi * CutLine(scene_.tissue).radius();
  r.stitches = stitches_of(task_.lapses, tissue_, order_.pairs().with_needle(tissue_), pass_time_, scene_.tissue);
  for (Stitch& s : r.stitches) {
    s.tear_time = std::fmin(tear_time_[static_cast<std::size_t>(s.first)], s.second < 0 ? kNaN : tear_time_[static_cast<std::size_t>(s.second)]);
    if (last != nullptr) name_tension(*last, s);
  }
  if (last != nullptr && !r.stitches.empty()) for (const StitchKnot& k : knots_in_tissue(*last, KnotOptions().closures, whole_front_)) name_knots(k, tissue_, r.stitches);
  const std::vector<double> ways = ways_to_next(r.stitches, scene_.tissue);
  for (std::size_t k = 0; k < ways.size(); ++k) r.stitches[k].next = ways[k];
  const bool complete = done() && std::isfinite(task_.lapses.line_gap);  // no other rules ask for the whole way round
  r.spacings = spacings_of(r.stitches, scene_.tissue, complete);
  r.lapses = lapses_of(task_.lapses, r.stitches, r.spacings, r.thickness, time_);
  find_back_walls(task_.lapses, tissue_, pass_time_, scene_.tissue, r.stitches, r.lapses);
  r.join = join;
  if (blood_.clamps().any()) r.clamps = blood_.clamps();
  if (blood_.milking().tests() + blood_.milking().spoiled > 0 || !std::isnan(blood_.milking().volume)) r.milking = blood_.milking();
  if (join && join->sound) {
    find_join_lapses(task_.lapses, *join, time_, r.lapses);
    find_gap_lapses(task_.lapses, *join, scene_.tissue, r.stitches, complete, time_, r.lapses);
    r.line_tested = complete && !join->edge.empty();
  }
  mark_critical(task_.lapses, r.lapses);
  r.soundness = tissue_.soundness;
  r.rules = task_.lapses.title;
  r.scales = task_.scales;
  return r;
}

}  // namespace filum
