#include "training/stitch_order.h"

#include <algorithm>
#include <cmath>

#include "base/numbers.h"
#include "training/cut_line.h"
#include "training/stitch_knot.h"

namespace filum {
namespace {

double turn_from(double a, double b) { return std::remainder(b - a, kTurn); }

}  // namespace

StitchOrder::StitchOrder(const std::vector<NeedleGoal>& goals, const TissueDescription& tissue) : goals_(goals), tissue_(tissue), filled_(goals.size(), 0) {
  tissue_.triangles.clear();  // places only
  tissue_.rest.resize(3, 0);
  made_.reserve(kMaxPasses);
}

bool StitchOrder::made(int goal) const { return filled_[static_cast<std::size_t>(goal)] >= rule(goal).count; }

int StitchOrder::turn() const {
  for (std::size_t g = 0; g < goals_.size(); ++g)
    if (goals_[g].kind == NeedleGoal::Kind::stitch && !made(static_cast<int>(g))) return static_cast<int>(g);
  return -1;
}

/// Of a running thread: one step on from the last stitch, the way it has gone so far.
bool StitchOrder::follows(int goal, const Made& m) const {
  const StitchRule& r = rule(goal);
  const Made *last = nullptr, *before = nullptr;
  for (const Made& other : made_) {
    if (other.goal < 0) continue;
    before = last;
    last = &other;
  }
  if (last == nullptr) return true;
  for (std::size_t side = 0; side < 2; ++side) {
    const double step = turn_from(last->angle[side], m.angle[side]);
    if (std::abs(std::abs(step) - r.apart) > r.within) return false;
    if (last->goal == goal && before != nullptr && step * turn_from(before->angle[side], last->angle[side]) < 0.0) return false;
  }
  return true;
}

bool StitchOrder::fits(int goal, const Made& m) const {
  const StitchRule& r = rule(goal);
  for (const double angle : m.angle) {
    const double in = angle - r.from - kTurn * std::floor((angle - r.from) / kTurn);
    if (r.span < kTurn && in > r.span) return false;
  }
  if (r.running) return follows(goal, m);
  for (const Made& other : made_) {
    if (&other == &m) continue;
    const bool stay = other.goal >= 0 && other.goal < goal && rule(other.goal).count == 1;
    for (std::size_t side = 0; side < 2; ++side) {
      const double between = std::abs(turn_from(other.angle[side], m.angle[side]));
      if (r.apart > 0.0 && stay && std::abs(between - r.apart) > r.within) return false;
      if (between < r.clear) return false;
    }
  }
  return true;
}

void StitchOrder::take(const Made& m, double time, std::vector<TaskEvent>& events) {
  int goal = turn();
  made_.push_back(m);
  if (goal < 0) return;  // more than asked for
  if (!fits(goal, made_.back())) {
    ++out_of_turn_;
    events.push_back({time, "stitch-out-of-turn", -1, m.angle[0], "rad", {}});
    return;
  }
  made_.back().goal = goal;
  ++filled_[static_cast<std::size_t>(goal)];
  for (bool filled = true; filled;) {  // the turn of those that wait may have come, in whatever order they were made
    filled = false;
    for (Made& waits : made_) {
      goal = turn();
      if (goal < 0) return;
      if (waits.goal >= 0 || !fits(goal, waits)) continue;
      waits.goal = goal;
      ++filled_[static_cast<std::size_t>(goal)];
      filled = true;
    }
  }
}

bool StitchOrder::asks_for(double angle) const { return turn() >= 0 && fits(turn(), {0, 0, {angle, angle}, -1}); }

void StitchOrder::make(double angle) {
  std::vector<TaskEvent> untold;
  take({0, 0, {angle, angle}, -1}, 0.0, untold);
}

void StitchOrder::observe(const Observation& o, std::vector<TaskEvent>& events) {
  pairs_.observe(o);
  for (; taken_ < pairs_.made().size(); ++taken_) {
    const std::array<int, 2>& pair = pairs_.made()[taken_];
    Made m{pair[0], pair[1], {}, -1};
    const CutLine cut(tissue_);
    for (const int k : pair) {
      const PassObservation& p = o.tissue.passes[static_cast<std::size_t>(k)];
      m.angle[static_cast<std::size_t>(p.side != 0)] = cut.angle({0.5 * (p.entry_rest + p.exit_rest), p.side});
    }
    take(m, o.time, events);
  }
}

bool StitchOrder::runs_on(int goal, const Observation& o) const {
  const auto arc = [&](int pass) { return o.tissue.passes[static_cast<std::size_t>(pass)].arc; };
  int start = -1;
  for (const Made& m : made_)
    if (m.goal >= 0 && m.goal < goal) start = m.first;
  ThreadPart piece;
  const std::vector<StitchKnot> knots = knots_in_tissue(o, 1);
  for (const Made& m : made_) {
    if (m.goal != goal) continue;
    if (start < 0) start = m.first;
    if (arc(start) < 0.0) return false;
    piece = piece_at(o, arc(start));
    for (const int k : {m.first, m.second}) {
      if (arc(k) < 0.0 || piece_at(o, arc(k)).first != piece.first) return false;
      if (std::any_of(knots.begin(), knots.end(), [&](const StitchKnot& knot) { return knot.holds(arc(k)); })) return false;
    }
  }
  return true;
}

}  // namespace filum
