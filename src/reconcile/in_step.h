#pragma once
// Hum against what follows the motion. Sampling slower than the mains folds 50 or 60 Hz onto any frequency; a misfit that depends on the motion stands on
// the harmonics of the motion's own period, with the same phase in every repetition, where hum has whatever phase it has (Bracewell 1986, ch. 10).

#include "reconcile/fit.h"

namespace filum::reconcile {

/// The frequency at which a record that is sampled evenly shows a line [Hz].
double folded(const Trial& t, double frequency);

/// Period of an input [s]: mean time between passages of its middle the same way, each from a tenth of the range before it to a tenth behind. The record's
/// length where it does not pass twice; 0 where it does not move.
double period_of(const Eigen::VectorXd& time, const Eigen::VectorXd& x);

/// Whether a line stands, as it is sampled, within the record's resolution (one over its length) of one of the first harmonics of an input's period.
bool on_harmonic(const Dataset& d, const Trial& t, double frequency, int harmonics);

/// Of the records that take part: chi-squared that is lost where repetitions of a protocol must share one amplitude and phase of the line at its folded
/// frequency, and how many free amplitudes that saves.
struct Shared {
  double lost = 0.0;
  int saved = 0;
};
Shared shared_line(const Fitter& fitter, const Fit& fit, double frequency, const std::vector<bool>& records);

}  // namespace filum::reconcile
