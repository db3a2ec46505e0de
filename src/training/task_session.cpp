#include "training/task_session.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

#include "training/metrics.h"
#include "training/score.h"
#include "training/thread_part.h"

namespace filum {

TaskSession::TaskSession(Task task, const SceneDescription& scene)
    : task_(std::move(task)),
      scene_(scene),
      recogniser_(task_, scene_),
      lab_(task_, scene_),
      log_(scene.n_tools, task_.time_limit) {
  if (task_.retraction) retraction_.emplace(*task_.retraction, scene_.brain.time_compression);
  if (task_.needle) needle_.emplace(*task_.needle, scene_);
  events_.reserve(kMaxEvents);
  for (auto& kind : last_kept_) kind.fill(-1.0);
}

bool TaskSession::scoring_paused(const Observation& o) {
  bool any = false, lost = false;
  for (std::size_t t = 0; t < static_cast<std::size_t>(o.n_tools); ++t) {
    const bool valid = o.tools[t].input_valid;
    lost = lost || (driven_[t] && !valid);
    any = any || valid;
    driven_[t] = driven_[t] || valid;
  }
  return lost || !any;
}

/// While an input is silent time stands still only as long as the hands that are left wait for it: the scene keeps what is done meanwhile, so the clock does too.
bool TaskSession::at_work(const Observation& o) {
  constexpr double kStill = 0.5e-3;  // [m], that a waiting hand may drift
  for (std::size_t t = 0; t < static_cast<std::size_t>(o.n_tools); ++t) {
    if (!paused_) rest_[t] = o.tools[t].X_WT.p;
    working_ = working_ || (o.tools[t].input_valid && (o.tools[t].X_WT.p - rest_[t]).norm() > kStill);
  }
  return working_ = working_ && paused_;
}

/// Events that may come every step are kept only every kEventPause for each tool; all others are kept.
bool TaskSession::crowds_out(const WorldEvent& e, double time) {
  constexpr std::array<std::string_view, 4> kFrequent = {"overrun", "slip", "solver-trouble",
                                                         "thread-overload"};
  const auto kind = std::find(kFrequent.begin(), kFrequent.end(), e.name);
  if (kind == kFrequent.end()) return false;
  const auto tool = static_cast<std::size_t>(std::clamp(e.tool + 1, 0, 3));
  double& last = last_kept_[static_cast<std::size_t>(kind - kFrequent.begin())][tool];
  if (last >= 0.0 && time - last < kEventPause) return true;
  last = time;
  return false;
}

void TaskSession::take_events(const Observation& o) {
  for (int k = 0; k < o.n_events; ++k) {
    const WorldEvent& e = o.events[static_cast<std::size_t>(k)];
    if (crowds_out(e, o.time)) continue;
    if (events_.size() < kMaxEvents) events_.push_back({o.time, e.name, e.tool, e.value, e.unit, {}});
  }
}

void TaskSession::take_sample(const Observation& o) {
  constexpr double kComing = 0.1;  // [s], in which instruments are drawn to where the hands that hold them are: no movement of theirs
  tension_ = std::max(tension_, largest_tension(o));
  const auto due = kComing + static_cast<double>(log_.size()) / kMetricRate;
  if (elapsed_ + 1e-9 < due) return;
  log_.add(o, tension_);
  tension_ = 0.0;
}

void TaskSession::observe(const Observation& o) noexcept {
  if (failed_) return;
  try {
    const bool first = !observed_;
    observed_ = true;
    const double dt = first ? 0.0 : std::max(0.0, o.time - previous_time_);
    previous_time_ = o.time;
    paused_ = scoring_paused(o);
    last_ = o;
    take_events(o);
    if (done()) return;
    const bool timed = at_work(o) || !paused_;
    if (timed) {
      elapsed_ += dt;
      take_sample(o);
    }
    if (needle_) {
      needle_->observe(o, dt, !paused_, events_);
    } else if (retraction_) {
      if (timed) retraction_->observe(o, dt, !paused_, events_);
    } else if (task_.laboratory) {
      lab_.observe(o, dt, !paused_, events_);
    } else if (!paused_) {
      recogniser_.observe(o, events_);
    }
  } catch (...) {
    failed_ = true;
  }
}

std::vector<TaskWarning> TaskSession::warnings() const {
  std::vector<TaskWarning> list;
  if (!observed_) return list;
  if (failed_)
    list.push_back({"danger", "scoring-stopped", "The trainer ran out of memory: scoring has stopped."});
  if (paused_)
    list.push_back({"danger", "input-lost", "An instrument's input is silent: scoring is paused. Wait for it: time goes on if you work meanwhile."});
  if (last_.broken) list.push_back({"danger", "thread-broken", "The thread has broken."});
  const double strength = scene_.thread_strength;
  if (!last_.broken && strength > 0.0 && largest_tension(last_) > task_.recognition.overload * strength) {
    list.push_back({"danger", "thread-overload", "Pulling too hard: the thread is about to break."});
  }
  for (int t = 0; t < last_.n_tools; ++t) {
    if (last_.tools[static_cast<std::size_t>(t)].grip_force <= task_.recognition.grip_limit) continue;
    const std::string& name = scene_.tools[static_cast<std::size_t>(t)].name;
    list.push_back({"warn", "grip", "Squeezing hard with " + name + "."});
  }
  for (int t = 0; t < last_.n_tools && scene_.tissue.lumen; ++t) {
    if (!last_.tissue.grips[static_cast<std::size_t>(t)].through) continue;
    list.push_back({"warn", "wall-held", scene_.tools[static_cast<std::size_t>(t)].name + " holds the wall through its thickness: that harms the intima. Take the adventitia only, or press with open tips."});
  }
  const std::string& seen = recogniser_.knot_class();
  const bool accepted = std::find(task_.accept.begin(), task_.accept.end(), seen) != task_.accept.end();
  if (retraction_)
    for (auto& [level, code, text] : retraction_->pressure().messages())
      if (!retraction_->blind() || code == "pressure-alarm") list.push_back({level, code, text});
  if (task_.has_knot() && recogniser_.n_throws() >= task_.throws && !accepted) {
    list.push_back(
        {"warn", "wrong-knot", "The knot now is: " + seen + ". Asked for: " + task_.accept.front() + "."});
  }
  if (elapsed_ > task_.time_limit) {
    list.push_back({"warn", "time-limit", "The time limit has passed: movements are no longer recorded."});
  }
  return list;
}

TaskStatus TaskSession::status() const {
  TaskStatus s;
  s.step_index = needle_ ? needle_->step() : retraction_ ? retraction_->step() : task_.laboratory ? lab_.step() : recogniser_.step();
  for (const TaskStep& step : task_.steps) s.steps.push_back(step.name);
  s.done = done();
  if (s.done) {
    s.step_name = "Done";
    s.hint = "All steps are done.";
  } else {
    const TaskStep& step = task_.steps[static_cast<std::size_t>(s.step_index)];
    s.step_name = step.name;
    s.hint = step.hint;
    if (step.kind == StepKind::follow) s.target = step.path;
    if (step.kind == StepKind::hold || step.kind == StepKind::place) s.target = step.at;
    s.within = step.within;
  }
  s.elapsed = elapsed_;
  s.paused = paused_ && observed_;
  s.knot_class = recogniser_.knot_class();
  s.warnings = warnings();
  if (retraction_) s.retraction = retraction_->pressure();
  s.blind = retraction_ && retraction_->blind();
  return s;
}

void TaskSession::measure_tails(const KnotReport& knot, Measures& measures) const {
  measures.short_tail = measures.long_tail = std::numeric_limits<double>::quiet_NaN();
  if (knot.core_begin < 0 || last_.cut_edge_low < 0 || last_.cut_edge_high < 0) return;
  const ThreadPart part = tied_part(last_);
  const double low = length_between(last_, part.first, part.first + knot.core_begin);
  const double high = length_between(last_, part.first + knot.core_end, part.last);
  measures.short_tail = std::min(low, high);
  measures.long_tail = std::max(low, high);
}

Result TaskSession::finish(const std::optional<SecurityTest>& security, const std::optional<JoinReport>& join) const {
  Result r;
  r.task = task_.name;
  r.title = task_.title;
  r.finished = done();
  r.has_knot = task_.has_knot();
  r.seconds = elapsed_;
  r.security = security;
  r.events = events_;
  if (retraction_) {
    r.pressure = retraction_->report();
    for (std::size_t i = 0; i < scene_.brain.blades.size() && static_cast<int>(i) < scene_.n_tools; ++i)
      r.pressure->blade_names.push_back(scene_.brain.blades[i].name);
    r.pressure->rest = scene_.brain.rest;
    r.pressure->triangles = scene_.brain.triangles;
  }
  if (needle_) r.needle = needle_->report(join, observed_ ? &last_ : nullptr);
  if (observed_ && task_.has_knot()) {
    const ThreadPart part = tied_part(last_);
    const Points nodes = last_.positions.middleCols(part.first, std::max(0, part.nodes()));
    r.knot = classify_knot(nodes, last_.radius, scene_.has_post ? &scene_.post : nullptr);
    if (!scene_.has_post) r.knot.encloses_post = true;  // nothing to enclose
  }
  r.measures = measure(log_, events_, scene_.thread_strength);
  r.measures.seconds = elapsed_;
  r.measures.throws = r.knot.n_throws;
  if (task_.laboratory) {
    r.measures.laboratory = true;
    r.measures.target_error = lab_.target_error();
    r.measures.target_longest = lab_.target_longest();
    r.measures.on_target = lab_.on_target();
    r.measures.force_share = lab_.force_share();
    r.measures.force_excess = lab_.force_excess();
    r.measures.objects_broken = lab_.broken();
  }
  measure_tails(r.knot, r.measures);
  score(task_, last_.broken, r);
  if (failed_) r.verdict.emplace_back("scoring stopped early: out of memory");
  add_curves(log_, scene_, r);
  if (r.pressure) add_pressure_curves(r);
  return r;
}

}  // namespace filum
