#pragma once
// Checks on a still hand's verdict that do not rest on the samples it was drawn from: repetitions of the baseline, and halves of the records.

#include "reconcile/hold_bands.h"

namespace filum::reconcile {

/// A still tip's residual against simulated ones: white noise on the same clocks with the same gaps, less the same slow polynomial. Two
/// statistics: the largest sum over a window, and the largest rise of Whittle's likelihood over octaves, the tremor's band and the lines
/// of heart, breath and mains. `fitted`: without the records that are held out. `stated`: noise of each output, 0 where it was estimated.
Detection detect_hold(const Dataset& d, const Fit& fitted, const Noise& noise, const std::vector<double>& stated, const Options& options);

/// Where no record is held out: the places of the named lines and bands are taken from one half of every record and judged in the other,
/// both ways. nullopt where a half has too few samples.
std::optional<Gap> gap_of_halves(const Dataset& d, const Noise& noise, const std::vector<Found>& found);

/// One line for each effect of the rig: the best of what was `looked` at, and why the others were not.
std::vector<Screened> screened_hold(const Result& r, const std::vector<Screened>& looked);

}  // namespace filum::reconcile
