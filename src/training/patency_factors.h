#pragma once
// What of a join is known to raise the risk of a thrombus, with its number and where that is from: factors, never a diagnosis, and no sum
// of them. Only the back-wall stitch is tied to short-term thrombosis by data (Paladino 2023: odds ratio 59 in rat arteries); the others
// are lapses that the literature names. Thresholds are those of the task's lapse rules. Test: patency_factors_test.

#include <string>
#include <vector>

#include "training/needle_watch.h"

namespace filum {

struct PatencyFactor {
  const char* name = "";
  const char* title = "";
  double value = 0.0;     // in `unit`; NaN: not measured
  const char* unit = "-";
  bool raised = false;
  const char* source = "";
};

/// Empty without a vessel.
std::vector<PatencyFactor> patency_factors(const NeedleReport& report);

}  // namespace filum
