#pragma once
// The result of a task run: score with the reason for every line, the knot, what happened and the curves.

#include <optional>
#include <string>
#include <vector>

#include "training/knot_classifier.h"
#include "training/needle_watch.h"
#include "training/retraction.h"
#include "training/step_recogniser.h"

namespace filum {

/// The knot pulled apart after the task (by whoever runs the world).
struct SecurityTest {
  bool held = false;        // neither slipped nor broke up to max_pull
  double slip_force = 0.0;  // [N], at which it slipped or broke; max_pull if it held
  double max_pull = 0.0;    // [N], strongest pull applied
  double elongation = 0.0;  // [m], of the loop at the end
};

struct ScoreItem {
  std::string name;  // name of the measure
  std::string title;
  std::optional<double> number;  // in `unit`; empty if text or not measured
  std::string text;              // where the value is a word
  std::string unit = "-";
  double points = 0.0;
  double max_points = 0.0;
  std::string why;
};

struct Curve {
  std::string name, title, unit;
  std::vector<double> time;   // [s], scene time
  std::vector<double> value;  // in `unit`
};

struct ToolPath {
  int tool = 0;
  std::string name;
  std::vector<double> positions;  // [m], x y z of each point in turn, frame W
  std::vector<double> time;       // [s]
};

/// What was measured, SI units; NaN where there was nothing to measure.
struct Measures {
  double seconds = 0.0;  // [s], scored time
  int throws = 0;
  double short_tail = 0.0;   // [m], of the cut tails; NaN if not both are cut
  double long_tail = 0.0;    // [m]
  double path_length = 0.0;  // [m], both hands
  int movements = 0;         // both hands
  double idle_time = 0.0;    // [s], in which no instrument moved
  double sparc = 0.0;        // median over movements
  double ldlj = 0.0;
  int sparc_segments = 0;  // movements that these medians are of
  int ldlj_segments = 0;
  double grip_peak = 0.0;    // [N], largest squeeze
  double grip_median = 0.0;  // [N], median of the peaks
  int grasps = 0;            // number of squeezes
  int drops = 0;
  double tension_peak = 0.0;  // [N]
  double overload = 0.0;      // largest tension as share of the thread's strength
  double both_moving = 0.0;   // share of time
  double speed_correlation = 0.0;
  double speed_lag = 0.0;  // [s]
  bool laboratory = false;       // the six below were asked for; NaN where there was nothing to measure
  double target_error = 0.0;     // [m], root mean square distance from the target
  double target_longest = 0.0;   // [m]
  double on_target = 0.0;        // share of the time within reach
  double force_share = 0.0;      // largest squeeze on an object over its strength
  double force_excess = 0.0;     // [N], mean squeeze over the least that holds
  int objects_broken = 0;
  double dominance = 0.0;  // share of the right-hand instrument in the path
};

struct Result {
  std::string task, title;
  bool finished = false;  // all steps done
  bool passed = false;
  bool has_knot = false;  // the task is one of tying a knot: `knot` means something
  double seconds = 0.0;  // [s], scored time
  double total = 0.0;    // points
  double max_total = 0.0;
  std::vector<ScoreItem> items;
  std::vector<std::string> verdict;  // why passed or not, in words
  KnotReport knot;
  std::optional<SecurityTest> security;
  std::optional<PressureReport> pressure;  // of brain retraction
  std::optional<NeedleReport> needle;      // of needle handling and stitches
  Measures measures;
  std::vector<TaskEvent> events;
  std::vector<Curve> series;  // at most kMaxCurvePoints each
  std::vector<ToolPath> paths;
};

inline constexpr std::size_t kMaxCurvePoints = 2000;

}  // namespace filum
