#pragma once
// Tasks with a needle: goals in turn, how the needle was held, which stitches were made and what was wrong with them.
//   pick     the tool holds the needle and nothing else touches the sheet
//   load     that tool alone holds it, at the place and angle asked for, for `seconds`
//   present  the needle's point stays within reach of a place for `seconds`
//   pass     the needle has gone right through the tissue so many times
//   draw     the thread follows until no more than `tail` is left before the first entry (of the thread that hangs on the needle now)
//   eye      the needle has gone into the card at one mark and come out of it at another, on one way after the eyes before it
//   tie      a knot of so many throws holds those ways, drawn down until no more thread is in its loop than `loop`, for `seconds`, and of the
//            classes of `knot` if any is asked for; looked at every quarter of a second
//   stitch   whole stitches at the places, and in the turn, that a technique asks for (training/stitch_order.h)
//   cut      the thread is cut on either side of the first so many ways that hold thread: before them as well where a fresh suture begins
// Events: goal-done, stitch-out-of-turn. Test: needle_watch_test.

#include <limits>
#include <optional>
#include <string_view>
#include <vector>

#include "training/needle_task.h"
#include "training/step_recogniser.h"
#include "training/stitch_order.h"
#include "training/task.h"
#include "world/observation.h"

namespace filum {

/// How tissue was held with instruments.
struct HandlingReport {
  int folds = 0, walls = 0, slips = 0;   // times it was taken by its adventitia, through its thickness; slid from between the pads
  double pull = 0.0;                     // [N], the most
};

/// At the end of a run. SI units; NaN where there was nothing to measure.
struct NeedleReport {
  int takes = 0, drops = 0;
  int out_of_turn = -1;                  // stitches; -1 where no order is asked for
  double angle_error = std::numeric_limits<double>::quiet_NaN();  // [rad], mean deviation from a right angle where load was asked for
  double share = std::numeric_limits<double>::quiet_NaN();        // where it was held then
  double present_error = std::numeric_limits<double>::quiet_NaN();  // [m], root mean square while presenting, or of the holes' distances from their marks
  bool has_tissue = false;
  double thickness = 0.0;                // [m]
  double round = std::numeric_limits<double>::quiet_NaN();  // [m], length of the cut round a vessel
  double peak_force = 0.0;               // [N], largest pull on the tissue
  HandlingReport handling;
  std::vector<Stitch> stitches;
  std::vector<double> spacings;          // [m], between neighbours
  std::vector<Lapse> lapses;
  std::string rules;                     // title of the rules
  double soundness = 1.0;                // of the weakest element of the tissue at the end: 1 whole, 0 gone
  std::optional<JoinReport> join;        // of a vessel with the clamps off
  std::optional<ClampReport> clamps;     // of a vessel, if the trainee took one off
  std::optional<MilkingReport> milking;  // if it was tried
  bool line_tested = false;              // the whole line was looked at under pressure: a line without the lapse is not disrupted
  std::vector<std::shared_ptr<const RatingScale>> scales;  // that raters mark it by
};

/// What a rubric line looks at; NaN for measures of other tasks.
double needle_value(Measure measure, const NeedleReport& report);

class NeedleWatch {
 public:
  NeedleWatch(const NeedleTask& task, const SceneDescription& scene);

  void observe(const Observation& o, double dt, bool scored, std::vector<TaskEvent>& events);
  int step() const { return step_; }
  bool done() const { return step_ == static_cast<int>(task_.goals.size()); }
  /// `join`: what the test of the join said, if there was one.
  /// `last`: the scene at the end, to name the stitches' knots by.
  NeedleReport report(const std::optional<JoinReport>& join = std::nullopt, const Observation* last = nullptr) const;

 private:
  bool met(const NeedleGoal& g, const Observation& o, double dt);
  bool through_eye(const NeedleGoal& g, const TissueObservation& t);
  bool tied(const NeedleGoal& g, const Observation& o);
  void follow_cuts(const Observation& o);
  bool cut_off(const Observation& o, int passes) const;
  void keep_times(const TissueObservation& t, double time);
  bool held_only_by(const Observation& o, int tool) const;

  NeedleTask task_;
  SceneDescription scene_;
  NeedleReport report_;
  TissueObservation tissue_;             // newest passes
  StitchOrder order_;
  BloodWatch blood_;
  std::vector<double> pass_time_, tear_time_;  // [s], when each way through the tissue was made, and had torn as far as counts
  std::vector<char> whole_front_;        // of each way: its suture still begins where it was laid
  bool whole_ = true;                    // so does the strand on the needle
  int step_ = 0;
  int used_ = 0;                         // ways through the tissue that belong to eyes
  double kept_ = 0.0, time_ = 0.0;       // [s]
  double next_knot_ = 0.0;               // [s], when the thread is looked at for knots again
  bool tied_ = false;                    // at the last look for this goal
  double angle_sum_ = 0.0, share_sum_ = 0.0, angle_time_ = 0.0, square_ = 0.0, present_time_ = 0.0;
};

}  // namespace filum
