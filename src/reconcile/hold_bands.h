#pragma once
// Lines and bands in the spectra of a still hand, and what of the power they leave.

#include "reconcile/hold_spectrum.h"
#include "reconcile/challenge.h"
#include "reconcile/screen.h"

namespace filum::reconcile {

/// A line or a band that stands out.
struct Found {
  Effect effect;
  const Form* form = nullptr;  // null: a band of random phase
  double low, high, frequency, power, evidence;  // [Hz]; power: squared rms [m2] of one record and output
  int bins;
};

/// Spectra of the residuals of records that are held out, or that are not, over `sigma` [m] of each output.
std::vector<Spectrum> spectra(const Dataset& d, const Fit& base, const std::vector<double>& sigma, bool held);
/// The band between 7.5 and 12.5 Hz that stands out most.
Band tremor_band(const std::vector<Spectrum>& all);
/// Adds the strongest line between two frequencies to `found`, if it is one; `looked` (may be null) is told what was seen.
void add_line(const Fitter& fitter, const Fit& base, const Form& form, double low, double high, const std::vector<Spectrum>& all, const HoldScreenOptions& options, std::vector<Found>& found, std::vector<Screened>* looked);
/// Hum at 50 or 60 Hz. Sampled at nearly that rate it is folded to where heart and breath are: then it must stand in what they leave, or it is the skirt of theirs.
void add_hum(const Fitter& fitter, const Fit& base, const Form& form, const std::vector<Spectrum>& all, const HoldScreenOptions& options, std::vector<Found>& found, std::vector<Screened>* looked);
/// The records without the lines that were found, so that what leaks from a strong line is not taken for something left over. A beat is no
/// pure sine: its second and third harmonic belong to it.
Fit without_lines(const Dataset& d, const Fit& base, const std::vector<Found>& found);
/// The octave with most power beside what was named: what nobody explains.
Band leftover(const std::vector<Spectrum>& all, const std::vector<Found>& found);
/// Rms over the noise before, and after what was found is given its bands.
Gap gap_in(const std::vector<Spectrum>& all, const std::vector<Found>& found);

}  // namespace filum::reconcile
