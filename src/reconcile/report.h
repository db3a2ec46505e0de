#pragma once
// Stage write: report.json (contract experiments.md), report.html (self-contained, inline SVG) and model.yaml. Each file appears whole or not
// at all (whole_file.h).

#include <nlohmann/json_fwd.hpp>

#include "reconcile/result.h"

namespace filum::reconcile {

nlohmann::ordered_json report_json(const Dataset& d, const Result& r);
std::string report_html(const Dataset& d, const Result& r, const std::string& program);
std::string model_yaml(const Dataset& d, const Result& r, const std::string& program);

/// The rules that this rig's verdict went by.
std::vector<RuleText> rules_of(const Dataset& d, const Result& r);

struct WriteOptions {
  std::string folder;   // made if need be
  std::string program;  // its version, for model.yaml and report.html
};
struct WriteSummary {
  std::vector<std::string> files;
};
/// The files that a result has, report.json last: its presence says that the report is whole.
std::vector<std::string> files_of(const Result& r);
WriteSummary write_report(const Dataset& d, const Result& r, const WriteOptions& options);

}  // namespace filum::reconcile
