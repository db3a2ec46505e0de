#pragma once
// Periodograms of a still hand's records and the power in their bands, judged by Whittle's likelihood (Whittle 1953): for N periodogram
// values of mean q times the white level, 2 log L rises by 2 N (q - 1 - log q). Test: hold_test.

#include <Eigen/Core>
#include <vector>

namespace filum::reconcile {

struct Spectrum {
  std::vector<double> frequency, power;  // [Hz], periodogram over the white level: mean 1
  double sigma = 1.0;                    // [m]
  double step = 1.0;
  int n = 0;
  double rate = 1.0;                     // [Hz], of the samples
};

/// Of one record and output, residual of the polynomial. sigma <= 0: taken from the median of the bins above 1.5 Hz outside the tremor band.
Spectrum spectrum(const Eigen::VectorXd& residual, const Eigen::VectorXd& time, double sigma);

struct Band {
  double low = 0, high = 0, mean = 1, background = 1, evidence = 0, centre = 0, top_share = 0, excess = 0;
  int bins = 0;
};

/// Power between two frequencies over all spectra, against `background`.
Band band(const std::vector<Spectrum>& all, double low, double high, double background);

/// White level between two frequencies, from the median.
double level(const std::vector<Spectrum>& all, double low, double high);

/// Squared rms in [m2] that a band holds above its background.
double squared_rms(const std::vector<Spectrum>& all, double low, double high, double background);

}  // namespace filum::reconcile
