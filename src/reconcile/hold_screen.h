#pragma once
// A still hand's stage screen: lines of heart, breath and mains, the tremor's band and clipped tops, each looked for where it would stand.

#include "reconcile/hold_bands.h"
#include "reconcile/hold_records.h"

namespace filum::reconcile {

struct HoldScreenSummary {
  std::vector<Found> found;           // lines and bands that stand out, the strongest first; the tremor last
  std::optional<NamedEffect> clipped; // the limit that a record's top or bottom shares
  std::vector<Screened> looked;       // everything that was looked at, with why it was not taken
  Band tremor;                        // the band between 7.5 and 12.5 Hz that stands out most
};

HoldScreenSummary screen_hold(const HoldRecords& records, const std::vector<Form>& forms, const HoldScreenOptions& options);

}  // namespace filum::reconcile
