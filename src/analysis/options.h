#pragma once
// The settings of an analysis; every one is told beside its results.

#include "analysis/grasp_force.h"
#include "analysis/tremor.h"

namespace filum {

inline constexpr double kSmoothnessAntiAlias = 40.0;  // [Hz]

struct AnalysisOptions {
  TremorOptions tremor;
  GraspOptions grasp;
  double window = 4.0;  // [s], of the pairs correlated within a session
};

}  // namespace filum
