#pragma once
// The analysis of one session or several as one JSON document. Every number stands beside the settings, the program's
// version and the device's noise floor that it depends on; what cannot be resolved is refused with its reason.

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "analysis/options.h"
#include "analysis/recorded_series.h"
#include "analysis/scatter_plot.h"

namespace filum {

struct AnalysisInput {
  std::vector<RecordedSession> sessions;
  std::optional<RecordedSession> clamped;   // same device, tool in a vice
  std::vector<RecordedSession> reference;   // experts, for the bands of grasp force
};

struct AnalysisReport {
  nlohmann::ordered_json json;
  std::vector<ScatterPanel> panels;
};

/// `program`: name and version that the values were derived with.
AnalysisReport analyse(const AnalysisInput& input, const std::string& program, const AnalysisOptions& options = {});

}  // namespace filum
