#pragma once
// Scatter plots as one SVG file: a panel for each pair of measures, a colour for each session, a small dot for each part of it and a ring
// for its mean. Lines: thin and in the session's colour, the slope within sessions through the session's mean; dashed, the least-squares
// line across the means of sessions. Test: scatter_plot_test.

#include <string>
#include <vector>

#include "analysis/correlation.h"

namespace filum {

struct ScatterPanel {
  std::string x_label, y_label;   // with the units shown
  std::vector<PairGroup> groups;
  Correlation within, across;
  double x_scale = 1.0, y_scale = 1.0;  // to the units shown
};

/// Names of more than 14 groups are left out: their colours would repeat.
std::string scatter_svg(const std::vector<ScatterPanel>& panels, const std::vector<std::string>& group_names);


}  // namespace filum
