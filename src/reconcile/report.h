#pragma once
// report.json (contract experiments.md), report.html (self-contained, inline SVG) and model.yaml. Each file appears whole or not
// at all (whole_file.h).

#include <nlohmann/json_fwd.hpp>

#include "reconcile/result.h"

namespace filum::reconcile {

nlohmann::ordered_json report_json(const Dataset& d, const Result& r);
std::string report_html(const Dataset& d, const Result& r, const std::string& program);
std::string model_yaml(const Dataset& d, const Result& r, const std::string& program);

/// The rules that this rig's verdict went by.
std::vector<RuleText> rules_of(const Dataset& d, const Result& r);
/// What each stage of the pipeline did, in a sentence.
struct StageText {
  std::string stage, summary;
};
std::vector<StageText> stages_of(const Dataset& d, const Result& r);
/// Writes all files of a result into a folder, made if need be.
void write_report(const Dataset& d, const Result& r, const std::string& folder, const std::string& program);

}  // namespace filum::reconcile
