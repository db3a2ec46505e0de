#pragma once
// From what was measured to points with reasons, and to passed or not.
//
// A task that was not carried through earns points for what was achieved: throws, the knot and its ends, stitches, and how well what can only be measured once
// it was done was done (each stitch's bites and angles, the needle's hold, the eyes). It earns none for what is full while little is done: time, path, drops,
// lapses, stitches out of turn, pull on the wall; nor for what is measured over the whole of a task (tracking a target, brain retraction). It never passes.

#include "training/result.h"
#include "training/series_log.h"
#include "training/task.h"

namespace filum {

/// Movement, grip and thread measures of a run. `strength` [N] is the thread's.
Measures measure(const SeriesLog& log, const std::vector<TaskEvent>& events, double strength);

/// Fills items, total, verdict and passed of `result`, whose knot, security, measures, finished and seconds
/// are known. `broken`: the thread has parted.
void score(const Task& task, bool broken, Result& result);

/// Curves and paths for the plots, thinned to kMaxCurvePoints.
void add_curves(const SeriesLog& log, const SceneDescription& scene, Result& result);

/// Pressure, dose and exposure of a retraction over time.
void add_pressure_curves(Result& result);

}  // namespace filum
