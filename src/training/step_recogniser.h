#pragma once
// Which step of a knot task the trainee is at, from what can be seen only:
//   loop     the thread winds round an instrument's axis by more than Recognition::loop_turns
//   pass     the end has been drawn through the loop: the thread's knot has one throw more (knot_classifier)
//   lay      that throw is there in three looks running, and the thread is off the instruments
//   tighten  the thread has since seen the tension peak asked for, and the knotted part sits on the post
//   cut      both tails are cut
// The knot is looked at five times a second of scene time at most, and only if the thread has moved.

#include <array>
#include <string>
#include <vector>

#include "training/task.h"
#include "world/observation.h"

namespace filum {

/// Something that happened, for the result and the plots.
struct TaskEvent {
  double time = 0.0;      // [s], scene time
  const char* name = "";  // static storage: "loop-formed", "end-passed", "throw-laid", "throw-tightened",
                          // "tail-cut", "throw-undone", "knot-changed", or an event of the world
  int tool = -1;
  double value = 0.0;  // in `unit`
  const char* unit = "-";
  std::string text;  // for people, may be empty
};

class StepRecogniser {
 public:
  StepRecogniser(const Task& task, const SceneDescription& scene);

  /// Looks at an observation; appends events to `events`.
  void observe(const Observation& o, std::vector<TaskEvent>& events);

  int step() const { return step_; }  // index of the present step; number of steps when done
  bool done() const { return step_ == static_cast<int>(task_.steps.size()); }
  int n_throws() const { return n_throws_; }                // in the thread now, as last seen
  const std::string& knot_class() const { return class_; }  // as last seen
  double wrap() const { return wrap_; }               // turns of the thread about an instrument, the largest
  int wrapped_tool() const { return wrapped_tool_; }  // that instrument, -1 none

 private:
  bool due(double& last, double interval, double time) const;
  void look_at_wraps(const Observation& o);
  void look_at_knot(const Observation& o, std::vector<TaskEvent>& events);
  void look_at_tightness(const Observation& o);
  bool fulfilled(const TaskStep& step, const Observation& o) const;
  void announce(const TaskStep& step, const Observation& o, std::vector<TaskEvent>& events);
  void step_back(const Observation& o, std::vector<TaskEvent>& events);

  Task task_;
  SceneDescription scene_;
  int step_ = 0;
  int n_throws_ = 0;
  std::string class_ = "unknot";
  int looks_at_this_many_ = 0;  // looks running with n_throws_
  int laid_ = 0;                // throws laid so far
  double wrap_ = 0.0;
  int wrapped_tool_ = -1;
  double peak_tension_ = 0.0;  // [N], since the present throw was laid
  double knot_turns_ = 0.0;    // length of the knotted part in circumferences of the post
  double last_wrap_ = -1.0, last_knot_ = -1.0, last_tight_ = -1.0;  // [s], time of the last look
  Points seen_;                                                     // nodes at the last look at the knot
};

/// Turns (signed) of the thread about the axis of a tool, the most of any stretch near the tool.
double wrap_turns(const Observation& o, const ToolObservation& tool);

}  // namespace filum
