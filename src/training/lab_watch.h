#pragma once
// Tasks of the laboratory: hold the tip still, follow a path, move small objects with little force. Watches the tip
// against targets that the task file gives, says where the trainee is and measures. Times are of the scene; nothing is
// judged here. Test: lab_watch_test.
//
//   hold    the clock starts when the tip first comes within reach of the target and runs `seconds`, whether the tip
//           stays or not: a record of tremor may have no gaps. Error: distance of the tip from the target.
//   follow  the tip goes along a polyline; progress only grows. Error: distance of the tip from the line.
//   place   an object is let go within reach of the target. Error: distance of its centre from the target, seen from above.
// Events: hold-begun, hold-done, trace-begun, trace-done, object-placed, object-lost, target-left, and once a second
// target-error (root mean square of the error since the last one).

#include <array>
#include <cstddef>
#include <vector>

#include "training/step_recogniser.h"
#include "training/task.h"

namespace filum {

class LabWatch {
 public:
  LabWatch(const Task& task, const SceneDescription& scene);

  /// Call after every step of the world, in order; `scored` is false while the input is silent.
  void observe(const Observation& o, double dt, bool scored, std::vector<TaskEvent>& events);

  int step() const { return step_; }
  bool done() const { return step_ == static_cast<int>(task_.steps.size()); }

  /// Of all steps so far; NaN where there was nothing to measure.
  double target_error() const;    // [m], root mean square
  double target_longest() const;  // [m]
  double on_target() const;       // share of the time within reach
  double force_share() const;     // largest squeeze on an object over its strength
  double force_excess() const;    // [N], mean squeeze over the least that holds, while objects were held
  int broken() const { return broken_; }

 private:
  void watch_point(const TaskStep& step, const Observation& o, double dt, std::vector<TaskEvent>& events);
  void watch_path(const TaskStep& step, const Observation& o, double dt, std::vector<TaskEvent>& events);
  void watch_object(const TaskStep& step, const Observation& o, std::vector<TaskEvent>& events);
  void watch_forces(const Observation& o, double dt);
  void take_error(double error, double within, const Observation& o, double dt, std::vector<TaskEvent>& events);
  void next(const char* event, const Observation& o, double value, const char* unit, std::vector<TaskEvent>& events);

  Task task_;
  SceneDescription scene_;
  int step_ = 0;
  bool begun_ = false;
  bool outside_ = false;
  double begun_at_ = 0.0;          // [s]
  double progress_ = 0.0;          // [m], along the path
  double square_ = 0.0, time_ = 0.0, time_on_ = 0.0, longest_ = 0.0;
  double recent_square_ = 0.0, recent_time_ = 0.0;
  double excess_ = 0.0, held_time_ = 0.0, force_share_ = 0.0;
  bool touched_ = false;           // an object was held
  std::array<bool, kMaxPellets> was_broken_{};
  int broken_ = 0;
};

/// Nearest point of a polyline [m, 3 x n] between arc lengths `from` and `to` [m].
struct PathPoint {
  double arc = 0.0;       // [m]
  double distance = 0.0;  // [m]
};
PathPoint nearest_on_path(const Points& path, const Vec3& p, double from, double to);
double length_of(const Points& path);

}  // namespace filum
