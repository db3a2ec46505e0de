#pragma once
// From what was measured to points with reasons, and to passed or not.

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
