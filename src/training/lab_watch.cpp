#include "training/lab_watch.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/numbers.h"

namespace filum {
namespace {

constexpr double kLookAhead = 2e-3;   // [m], further along the path than the tip may jump in a step
constexpr double kErrorEvery = 1.0;   // [s]

}  // namespace

double length_of(const Points& path) {
  double sum = 0.0;
  for (Eigen::Index k = 1; k < path.cols(); ++k) sum += (path.col(k) - path.col(k - 1)).norm();
  return sum;
}

PathPoint nearest_on_path(const Points& path, const Vec3& p, double from, double to) {
  PathPoint best{from, std::numeric_limits<double>::infinity()};
  double arc = 0.0;
  for (Eigen::Index k = 1; k < path.cols(); ++k) {
    const Vec3 a = path.col(k - 1), d = path.col(k) - path.col(k - 1);
    const double length = d.norm();
    if (arc + length >= from && arc <= to && length > 0.0) {
      const double low = std::max(0.0, (from - arc) / length), high = std::min(1.0, (to - arc) / length);
      const double share = std::clamp(d.dot(p - a) / (length * length), low, high);
      const double distance = (a + share * d - p).norm();
      if (distance < best.distance) best = {arc + share * length, distance};
    }
    arc += length;
  }
  return best;
}

LabWatch::LabWatch(const Task& task, const SceneDescription& scene) : task_(task), scene_(scene) {}

void LabWatch::observe(const Observation& o, double dt, bool scored, std::vector<TaskEvent>& events) {
  watch_forces(o, dt);
  if (done() || !scored) return;
  const TaskStep& step = task_.steps[static_cast<std::size_t>(step_)];
  switch (step.kind) {
    case StepKind::hold:
      return watch_point(step, o, dt, events);
    case StepKind::follow:
      return watch_path(step, o, dt, events);
    case StepKind::place:
      return watch_object(step, o, events);
    default:
      return;
  }
}

void LabWatch::next(const char* event, const Observation& o, double value, const char* unit, std::vector<TaskEvent>& events) {
  events.push_back({o.time, event, task_.lab_tool, value, unit, task_.steps[static_cast<std::size_t>(step_)].name});
  ++step_;
  begun_ = outside_ = false;
  progress_ = recent_square_ = recent_time_ = 0.0;
}

void LabWatch::take_error(double error, double within, const Observation& o, double dt, std::vector<TaskEvent>& events) {
  square_ += error * error * dt;
  time_ += dt;
  longest_ = std::max(longest_, error);
  if (error <= within) time_on_ += dt;
  if (error > within && !outside_) events.push_back({o.time, "target-left", task_.lab_tool, error, "m", {}});
  outside_ = error > within;
  recent_square_ += error * error * dt;
  recent_time_ += dt;
  if (recent_time_ < kErrorEvery - 0.5 * dt) return;
  events.push_back({o.time, "target-error", task_.lab_tool, std::sqrt(recent_square_ / recent_time_), "m", {}});
  recent_square_ = recent_time_ = 0.0;
}

void LabWatch::watch_point(const TaskStep& step, const Observation& o, double dt, std::vector<TaskEvent>& events) {
  const double error = (o.tools[static_cast<std::size_t>(task_.lab_tool)].X_WT.p - step.at).norm();
  if (!begun_ && error <= step.within) {
    begun_ = true;
    begun_at_ = o.time;
    events.push_back({o.time, "hold-begun", task_.lab_tool, step_ + 1.0, "-", step.name});
  }
  if (!begun_) return;
  take_error(error, step.within, o, dt, events);
  if (o.time - begun_at_ >= step.seconds) next("hold-done", o, step_ + 1.0, "-", events);
}

void LabWatch::watch_path(const TaskStep& step, const Observation& o, double dt, std::vector<TaskEvent>& events) {
  const Vec3 tip = o.tools[static_cast<std::size_t>(task_.lab_tool)].X_WT.p;
  if (!begun_ && (tip - step.path.col(0)).norm() <= step.within) {
    begun_ = true;
    events.push_back({o.time, "trace-begun", task_.lab_tool, step_ + 1.0, "-", step.name});
  }
  if (!begun_) return;
  const PathPoint at = nearest_on_path(step.path, tip, progress_, progress_ + kLookAhead);
  if (at.distance <= 4.0 * step.within) progress_ = std::max(progress_, at.arc);
  take_error(at.distance, step.within, o, dt, events);
  if (progress_ >= length_of(step.path) - step.within) next("trace-done", o, progress_, "m", events);
}

void LabWatch::watch_object(const TaskStep& step, const Observation& o, std::vector<TaskEvent>& events) {
  if (step.object >= o.n_pellets) return;
  const PelletObservation& object = o.pellets[static_cast<std::size_t>(step.object)];
  if (object.broken) return next("object-lost", o, static_cast<double>(step.object), "-", events);
  const double error = (object.p_W - step.at).head<2>().norm();
  const bool rests = object.holder < 0 && object.p_W.z() < scene_.floor_height + 1.05 * scene_.pellets[static_cast<std::size_t>(step.object)].radius;
  if (!rests || error > step.within) return;
  square_ += error * error;
  time_ += 1.0;
  time_on_ += 1.0;
  longest_ = std::max(longest_, error);
  events.push_back({o.time, "target-error", task_.lab_tool, error, "m", {}});
  next("object-placed", o, static_cast<double>(step.object), "-", events);
}

void LabWatch::watch_forces(const Observation& o, double dt) {
  for (int k = 0; k < o.n_pellets; ++k) {
    const PelletObservation& object = o.pellets[static_cast<std::size_t>(k)];
    bool& was_broken = was_broken_[static_cast<std::size_t>(k)];
    if (object.broken && !was_broken) {
      was_broken = true;
      ++broken_;
      force_share_ = std::max(force_share_, 1.0);
      touched_ = true;
    }
    if (object.holder < 0) continue;
    const PelletShape& shape = scene_.pellets[static_cast<std::size_t>(k)];
    const double squeeze = o.tools[static_cast<std::size_t>(object.holder)].grip_force;
    touched_ = true;
    force_share_ = std::max(force_share_, squeeze / shape.strength);
    excess_ += (squeeze - shape.slip_limit) * dt;
    held_time_ += dt;
  }
}

double LabWatch::target_error() const { return time_ > 0.0 ? std::sqrt(square_ / time_) : kNaN; }
double LabWatch::target_longest() const { return time_ > 0.0 ? longest_ : kNaN; }
double LabWatch::on_target() const { return time_ > 0.0 ? time_on_ / time_ : kNaN; }
double LabWatch::force_share() const { return touched_ ? force_share_ : kNaN; }
double LabWatch::force_excess() const { return held_time_ > 0.0 ? excess_ / held_time_ : kNaN; }

}  // namespace filum
