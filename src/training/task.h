#pragma once
// A task as its file curricula/<task>/task.yaml defines it: steps with hints, what passes, and a rubric whose
// every line carries its bands, points and the source of the numbers. Format filum-task/1; unknown keys are
// refused (InputError). Marks made from it are the simulator's estimates, no validated clinical score.

#include <memory>
#include <string>
#include <vector>

#include "base/yaml_file.h"
#include "training/retraction_task.h"

namespace filum {

struct NeedleTask;  // training/needle_task.h

enum class StepKind { loop, pass, lay, tighten, cut, hold, follow, place };

struct TaskStep {
  StepKind kind = StepKind::loop;
  int throw_number = 1;  // from 1; 0 for cut
  std::string name;      // for people
  std::string hint;
  // Of the laboratory's steps (training/lab_watch.h), frame W:
  Vec3 at = Vec3::Zero();  // [m], hold, place
  double within = 0.0;     // [m], reach of the target
  double seconds = 0.0;    // [s], hold
  Points path;             // [m], 3 x n, follow
  int object = 0;          // place
};

/// What a rubric line looks at; the SI unit of its value is unit_of(measure).
enum class Measure {
  time,
  throws,
  knot_class,
  security,
  tail_lengths,
  path_length,
  movements,
  idle_time,
  sparc,
  ldlj,
  grip_peak,
  drops,
  thread_overload,
  both_moving,
  target_error,
  target_longest,
  on_target,
  force_share,
  force_excess,
  objects_broken,
  pressure_peak,
  pressure_tip,
  pressure_dose,
  time_in_red,
  time_over,
  hold_peak,
  releases,
  press_error,
  loaded_longest,
  exposed,
  slips,
  edge_cuts,
  veins_torn,
  needle_angle,
  needle_share,
  needle_takes,
  needle_drops,
  needle_present,
  tissue_takes,
  wall_grasps,
  tissue_slips,
  grip_pull,
  stitch_order,
  stitches,
  bite_inequality,
  bite_widest,
  entry_error,
  obliquity,
  tissue_pull,
  lapses,
};
const char* name_of(Measure measure);
const char* unit_of(Measure measure);

/// Share of the points by value: 0 up to zero_below, 1 between full_from and full_to, 0 from zero_above,
/// straight lines between. SI units of the measure.
struct Band {
  double zero_below, full_from, full_to, zero_above;
  double share(double value) const;
};

struct RubricItem {
  Measure measure = Measure::time;
  std::string title;
  double points = 0.0;  // most that can be had
  std::string unit;     // shown, e.g. "mm"
  Band band{};          // not used by knot_class
  std::string source;   // where the numbers come from
};

struct Recognition {
  double loop_turns = 0.75;     // turns of the thread about an instrument that count as a loop
  double tight_tension = 5e-3;  // [N], peak of the thread's tension that a tightened throw has seen
  double tight_turns =
      2.5;                // length of the knotted part in circumferences of the post, below which it is tight
  double overload = 0.8;  // share of the thread's strength that counts as overload
  double grip_limit = 2.0;  // [N], squeeze above which the trainee is warned
};

struct Task {
  std::string name, title, description;
  std::string suture;               // model name
  bool demonstration_only = false;  // never passes
  bool laboratory = false;          // no knot: hold, follow, place
  int lab_tool = 0;                 // whose tip is watched
  std::shared_ptr<const RetractionTask> retraction;  // of brain retraction: goals and limits; else none
  std::shared_ptr<const NeedleTask> needle;  // of needle handling and stitches, else none
  bool has_knot() const { return !laboratory && !retraction && !needle; }
  double time_limit = 600.0;        // [s], scored time that is recorded
  std::vector<std::string> accept;  // knot classes that pass
  int throws = 2;                   // throws that the knot has
  double required_security = 0.0;   // [N], a knot that slips below this does not pass
  double pass_points = 0.0;         // least total
  Recognition recognition;
  std::vector<TaskStep> steps;
  std::vector<RubricItem> rubric;
  double max_total() const;
};

/// Throws InputError naming file, field, value and what was expected.
Task load_task(const std::string& path);
/// `root`: of the files a task names.
Task parse_task(const YamlNode& file, const std::string& root = ".");

}  // namespace filum
