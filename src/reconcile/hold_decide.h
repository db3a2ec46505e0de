#pragma once
// A still hand's stages decide and localise: a verdict by the power that the names hold and what is left beside them, and where in the records that power is.

#include "reconcile/hold_fit.h"

namespace filum::reconcile {

/// The octave with most power beside what was named.
struct HoldLeft {
  Band band;
  double rms = 0.0;          // [m]
  bool unexplained = false;  // by the rules
};
HoldLeft left_beside(const HoldRecords& records, const std::vector<Found>& found, double materiality, const HoldDecideOptions& options);

DecideSummary decide_hold(const HoldRecords& records, const std::vector<Found>& found, HoldFitSummary fitted, const HoldLeft& left, const HoldDecideOptions& options);

LocaliseSummary localise_hold(const HoldRecords& records, const std::vector<Found>& found, const HoldLeft& left, const std::string& verdict, const LocaliseOptions& options);
/// The octave that nothing explains, with the share of resamplings of the records that choose it again.
std::vector<Term> describe_hold(const HoldRecords& records, const std::vector<Found>& found, const HoldLeft& left, int resamplings);

}  // namespace filum::reconcile
