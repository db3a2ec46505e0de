#include "training/step_recogniser.h"

#include <algorithm>
#include <cmath>

#include "base/numbers.h"
#include "training/knot_classifier.h"
#include "training/knot_shape.h"
#include "training/knot_table.h"
#include "training/thread_part.h"

namespace filum {
namespace {

constexpr double kReachAhead = 1e-3;    // [m], of the jaw tips, within which thread counts as round the tool
constexpr double kReachBehind = 15e-3;  // [m], behind the tips
constexpr double kReachAside = 5e-3;    // [m], from the axis
constexpr double kHeldTurns = 0.5;      // of a strand that goes straight through the jaws that hold it
constexpr int kLooksToLay = 3;
constexpr int kLooksToUndo = 5;

Points part_nodes(const Observation& o, const ThreadPart& part) {
  return o.positions.middleCols(part.first, std::max(0, part.nodes()));
}

const char* event_name(StepKind kind) {
  switch (kind) {
    case StepKind::loop:
      return "loop-formed";
    case StepKind::pass:
      return "end-passed";
    case StepKind::lay:
      return "throw-laid";
    case StepKind::tighten:
      return "throw-tightened";
    case StepKind::cut:
      return "tails-cut";
    default:
      return "";  // the laboratory's steps are announced by LabWatch
  }
  return "";
}

}  // namespace

double wrap_turns(const Observation& o, const ToolObservation& tool) {
  const ThreadPart part = tied_part(o);
  const Pose X_TW = tool.X_WT.inverse();
  double most = 0.0, sum = 0.0, before = 0.0;
  bool inside = false;
  for (int k = part.first; k <= part.last; ++k) {
    const Vec3 p = X_TW * Vec3(o.positions.col(k));
    const bool near = p.z() > -kReachAhead && p.z() < kReachBehind && std::hypot(p.x(), p.y()) < kReachAside;
    const double angle = std::atan2(p.y(), p.x());
    sum = near && inside ? sum + std::remainder(angle - before, kTurn) : 0.0;
    inside = near;
    before = angle;
    if (std::abs(sum) > std::abs(most)) most = sum;
  }
  return most / kTurn;
}

StepRecogniser::StepRecogniser(const Task& task, const SceneDescription& scene)
    : task_(task), scene_(scene) {}

bool StepRecogniser::due(double& last, double interval, double time) const {
  if (last >= 0.0 && time - last < interval && time >= last) return false;
  last = time;
  return true;
}

void StepRecogniser::look_at_wraps(const Observation& o) {
  wrap_ = 0.0;
  wrapped_tool_ = -1;
  for (int t = 0; t < o.n_tools; ++t) {
    const ToolObservation& tool = o.tools[static_cast<std::size_t>(t)];
    double turns = wrap_turns(o, tool);
    if (tool.grasped_edge >= 0) turns = std::copysign(std::max(std::abs(turns) - kHeldTurns, 0.0), turns);
    if (std::abs(turns) <= std::abs(wrap_)) continue;
    wrap_ = turns;
    wrapped_tool_ = t;
  }
}

void StepRecogniser::look_at_knot(const Observation& o, std::vector<TaskEvent>& events) {
  const Points nodes = part_nodes(o, tied_part(o));
  const bool same_size = seen_.cols() == nodes.cols() && nodes.cols() > 0;
  const bool moved = !same_size || (nodes - seen_).colwise().norm().maxCoeff() > 0.5 * o.radius;
  if (moved) {
    seen_ = nodes;
    KnotOptions options;
    options.closures = 1;
    options.shape = false;
    const KnotReport report = classify_knot(nodes, o.radius, nullptr, options);
    // A tangle that is no stack of throws says nothing about how many there are: the last count stands.
    const bool stack = report.n_throws > 0 || report.knot_class == "unknot";
    const int throws = stack ? report.n_throws : n_throws_;
    looks_at_this_many_ = throws == n_throws_ && stack ? looks_at_this_many_ + 1 : 1;
    if (report.knot_class != class_) {
      events.push_back({o.time, "knot-changed", -1, static_cast<double>(throws), "-", report.knot_class});
    }
    n_throws_ = throws;
    class_ = report.knot_class;
  } else {
    ++looks_at_this_many_;
  }
}

void StepRecogniser::look_at_tightness(const Observation& o) {
  const ThreadPart part = tied_part(o);
  const Points nodes = part_nodes(o, part);
  if (nodes.cols() < 4 || !nodes.allFinite() || !scene_.has_post) return;
  KnotReport report;
  find_core(nodes, jones_of_thread(nodes, 1), 1, report);
  const double length = length_between(o, part.first + report.core_begin, part.first + report.core_end);
  knot_turns_ = length / (kTurn * (scene_.post.radius + o.radius));
}

bool StepRecogniser::fulfilled(const TaskStep& step, const Observation& o) const {
  const Recognition& r = task_.recognition;
  const bool has_throw = n_throws_ >= step.throw_number;
  switch (step.kind) {
    case StepKind::loop:
      return std::abs(wrap_) >= r.loop_turns || has_throw;
    case StepKind::pass:
      return has_throw;
    case StepKind::lay:
      return has_throw && looks_at_this_many_ >= kLooksToLay && std::abs(wrap_) < 0.5;
    case StepKind::tighten:
      return has_throw && peak_tension_ >= r.tight_tension && knot_turns_ > 0.0 &&
             knot_turns_ <= r.tight_turns;
    case StepKind::cut:
      return o.cut_edge_low >= 0 && o.cut_edge_high >= 0;
    default:
      return false;
  }
  return false;
}

void StepRecogniser::announce(const TaskStep& step, const Observation& o, std::vector<TaskEvent>& events) {
  TaskEvent event{o.time, event_name(step.kind), -1, static_cast<double>(step.throw_number), "-", step.name};
  if (step.kind == StepKind::loop && std::abs(wrap_) >= task_.recognition.loop_turns) {
    event.tool = wrapped_tool_;
    event.value = wrap_;
    event.unit = "turn";
  }
  if (step.kind == StepKind::lay) {
    laid_ = step.throw_number;
    peak_tension_ = 0.0;
    knot_turns_ = 0.0;
  }
  events.push_back(std::move(event));
}

void StepRecogniser::step_back(const Observation& o, std::vector<TaskEvent>& events) {
  if (n_throws_ >= laid_ || looks_at_this_many_ < kLooksToUndo) return;
  laid_ = n_throws_;
  events.push_back(
      {o.time, "throw-undone", -1, static_cast<double>(n_throws_), "-", "a throw has come undone"});
  const auto again = std::find_if(task_.steps.begin(), task_.steps.end(),
                                  [&](const TaskStep& s) { return s.throw_number == n_throws_ + 1; });
  if (again != task_.steps.end()) step_ = static_cast<int>(again - task_.steps.begin());
}

void StepRecogniser::observe(const Observation& o, std::vector<TaskEvent>& events) {
  peak_tension_ = std::max(peak_tension_, largest_tension(o));
  if (due(last_wrap_, 0.05, o.time)) look_at_wraps(o);
  if (!due(last_knot_, 0.2, o.time)) return;
  look_at_knot(o, events);
  step_back(o, events);
  if (!done() && task_.steps[static_cast<std::size_t>(step_)].kind == StepKind::tighten &&
      peak_tension_ >= task_.recognition.tight_tension && due(last_tight_, 0.5, o.time)) {
    look_at_tightness(o);
  }
  while (!done()) {
    const TaskStep& step = task_.steps[static_cast<std::size_t>(step_)];
    if (!fulfilled(step, o)) break;
    announce(step, o, events);
    ++step_;
  }
}

}  // namespace filum
