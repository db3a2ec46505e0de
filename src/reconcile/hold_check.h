#pragma once
// A still hand's stages detect and challenge: checks on its verdict that do not rest on the samples it was drawn from: repetitions of the baseline,
// and halves of the records.

#include "reconcile/detect.h"
#include "reconcile/hold_bands.h"
#include "reconcile/hold_records.h"

namespace filum::reconcile {

/// A still tip's residual against simulated ones: white noise on the same clocks with the same gaps, less the same slow polynomial. Two
/// statistics: the largest sum over a window, and the largest rise of Whittle's likelihood over octaves, the tremor's band and the lines
/// of heart, breath and mains.
DetectSummary detect_hold(const HoldRecords& records, const HoldDetectOptions& options, const Run& run);

/// Where no record is held out, the places of the named lines and bands are taken from one half of every record and judged in the other, both ways; where
/// half a record is too short, the bands stand on the fitted ones.
ChallengeSummary challenge_hold(const HoldRecords& records, const std::vector<Found>& found, const HoldChallengeOptions& options);

/// One line for each effect of the rig: the best of what was `looked` at, and why the others were not.
std::vector<Screened> screened_hold(const LintSummary& lint, const std::vector<Screened>& looked);

}  // namespace filum::reconcile
