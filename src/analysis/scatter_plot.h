#pragma once
// Scatter plots as one SVG file: a panel for each pair of measures, a colour for each session, the line of the relation
// within sessions.

#include <string>
#include <vector>

#include "analysis/correlation.h"

namespace filum {

struct ScatterPanel {
  std::string x_label, y_label;   // with units
  std::vector<PairGroup> groups;
  Correlation within, across;
};

std::string scatter_svg(const std::vector<ScatterPanel>& panels, const std::vector<std::string>& group_names);

}  // namespace filum
