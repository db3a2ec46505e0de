#pragma once
// What a residual still holds: block sums of whitened residuals (slow structure), overdispersion, lines in the spectrum; and the
// noise itself, from replicates or from differences of neighbouring samples (variogram).

#include "reconcile/fit.h"

namespace filum::reconcile {

struct Structure {
  double excess = 0.0;   // sum over blocks of (block sum)^2/L - 1, at the block length where it stands out most
  double z = 0.0;        // in standard deviations of a white residual
  int length = 1;        // [samples]
  double dispersion = 1.0;  // mean of (block sum)^2/L there, at least 1
};

/// Over block lengths 1, 2, 4 ...; `length` > 0 asks for that one alone.
Structure structure_of(const std::vector<Eigen::VectorXd>& white, int parameters, int length = 0);

/// Noise of each output from the residuals of a fit; what the dataset states is kept. `previous` gives full scales.
Noise estimate_noise(const Fitter& fitter, const Fit& fit);
/// Spread of the records' stiffness within groups of replicates, from a fit with a loose prior.
double replicate_scatter(const Dataset& d, const Fit& loose);
/// Overdispersion that replicates show among each other (their common misfit cancels), at least 1.
double replicate_dispersion(const Fitter& fitter, const Fit& fit, int length = 0);

/// The largest |sum of a window| / sqrt(length) of whitened residuals, windows of 4, 8, 16 ... samples in steps of a quarter: slow misfit
/// and short events alike.
struct Window {
  double value = 0.0;
  std::size_t trial = 0;
  Eigen::Index from = 0, length = 0;  // [samples]
};
Window strongest_window(const std::vector<Eigen::VectorXd>& white);

struct Line {
  double frequency = 0.0;  // [Hz]
  double gain = 0.0;       // fall of chi2, against the local background
  int columns = 0;         // free amplitudes it costs
  double background = 1.0; // power about it, over what the noise has there
};
/// Upper tail of chi-squared with an even number of degrees of freedom: exp(-x/2) sum (x/2)^j/j!, j below half of them.
double chi2_tail(double x, int freedom);
/// The strongest line between two frequencies, summed over records and outputs with free phase.
Line strongest_line(const Fitter& fitter, const Fit& fit, double low, double high);

}  // namespace filum::reconcile
