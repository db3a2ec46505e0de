#pragma once
// One run of a task: watches observations, says where the trainee is, and gives the result. Call observe()
// after every step of the world, in order. It is cheap (sampling into reserved memory; the knot is looked at
// five times a second of scene time, below a millisecond each for a thread of 200 nodes); it neither throws
// nor blocks. While an instrument that was driven before is not (input_valid false), or none is, no step and no goal
// is met; scored time stands still then until an instrument that is still driven works on. After the last step scoring stops; only the knot is still taken from the newest observation.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "training/lab_watch.h"
#include "training/needle_watch.h"
#include "training/retraction.h"
#include "training/result.h"
#include "training/series_log.h"
#include "training/step_recogniser.h"
#include "training/task.h"

namespace filum {

struct TaskWarning {
  std::string level;  // "info" | "warn" | "danger"
  std::string code;   // "input-lost", "thread-overload", "grip", "wrong-knot", "thread-broken", "time-limit"
  std::string text;
};

struct TaskStatus {
  int step_index = 0;  // equals the number of steps when done
  std::string step_name;
  std::vector<std::string> steps;  // names of all
  std::string hint;
  Points target = Points(3, 0);    // [m], of a laboratory's step: a point, or a path to follow
  double within = 0.0;             // [m], its reach
  double elapsed = 0.0;  // [s], scored time
  bool done = false;
  bool paused = false;                // no step or goal is met
  std::string knot_class;             // as seen now
  std::vector<TaskWarning> warnings;  // in force now
  std::optional<PressureWatch> retraction;  // of brain retraction: pressure and dose now
  bool blind = false;                       // and whether they are to be hidden
};

class TaskSession {
 public:
  TaskSession(Task task, const SceneDescription& scene);

  void observe(const Observation& o) noexcept;
  TaskStatus status() const;
  /// Events since the start, in order, at most kMaxEvents of the world's. Events that may come every step
  /// ("overrun", "slip", "solver-trouble", "thread-overload") are kept once every kEventPause for each tool.
  const std::vector<TaskEvent>& events() const { return events_; }
  bool done() const { return needle_ ? needle_->done() : retraction_ ? retraction_->done() : task_.laboratory ? lab_.done() : recogniser_.done(); }
  /// Of brain retraction, else none.
  const RetractionWatch* retraction() const { return retraction_ ? &*retraction_ : nullptr; }
  const Task& task() const { return task_; }

  /// Classifies the knot anew and scores. May be called again, e.g. once the security test has been made.
  Result finish(const std::optional<SecurityTest>& security = std::nullopt, const std::optional<JoinReport>& join = std::nullopt) const;

  static constexpr std::size_t kMaxEvents = 4096;
  static constexpr double kEventPause = 0.25;  // [s]

 private:
  bool scoring_paused(const Observation& o);
  bool at_work(const Observation& o);
  bool crowds_out(const WorldEvent& e, double time);
  void take_events(const Observation& o);
  void take_sample(const Observation& o);
  std::vector<TaskWarning> warnings() const;
  void measure_tails(const KnotReport& knot, Measures& measures) const;

  Task task_;
  SceneDescription scene_;
  StepRecogniser recogniser_;
  LabWatch lab_;  // of the laboratory's tasks, in place of the recogniser
  std::optional<RetractionWatch> retraction_;  // of brain retraction, in place of both
  std::optional<NeedleWatch> needle_;          // of needle and stitches, in place of them
  SeriesLog log_;
  std::vector<TaskEvent> events_;
  Observation last_;  // newest
  bool observed_ = false;
  bool paused_ = true;
  bool failed_ = false;           // watching failed (out of memory): scoring stopped, said in the result
  std::array<bool, 3> driven_{};  // instrument has had a valid input
  std::array<Vec3, 3> rest_{};    // [m], where each was when an input fell silent
  bool working_ = false;          // and one has moved since
  std::array<std::array<double, 4>, 4>
      last_kept_{};              // [s], of each frequent kind and tool (from -1), -1 never
  double previous_time_ = -1.0;  // [s]
  double elapsed_ = 0.0;         // [s], scored
  double tension_ = 0.0;         // [N], largest since the last sample
};

}  // namespace filum
