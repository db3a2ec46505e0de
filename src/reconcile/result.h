#pragma once
// A reconciliation: its stages in the order in which they run, what each found, written as report.json (contract), report.html and model.yaml. Detection and
// localisation come after the fits, since what no set of effects takes away counts as noise in them.

#include "reconcile/baseline.h"
#include "reconcile/decide.h"
#include "reconcile/detect.h"

namespace filum::reconcile {

struct Result {
  LintSummary lint;
  NoiseSummary noise;
  BaselineSummary baseline;
  ScreenSummary screen;
  FitSummary fit;
  std::optional<DetectSummary> detect;
  ChallengeSummary challenge;
  std::optional<ConfirmSummary> confirm;
  DecideSummary decide;
  LocaliseSummary localise;
  DescribeSummary describe;
  std::optional<NextSummary> next;
  std::vector<Form> forms;  // owned here, since fits point to them
  Rules rules;              // that it went by
  double seconds = 0.0;
};

struct Options : Run {
  Rules rules;
};

Result reconcile(const Dataset& d, const Options& options = {});
/// tip-hold has no input: its effects are told apart in the spectrum (hold.cpp).
Result reconcile_hold(const Dataset& d, const RigModel& model, const Options& options);

}  // namespace filum::reconcile
