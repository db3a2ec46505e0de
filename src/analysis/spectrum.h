#pragma once
// Power spectral density by averaged modified periodograms (P. D. Welch, IEEE Trans. Audio Electroacoust. 15
// (1967) 70-73), one-sided, so that the sum of density times df is the variance:
//   S(f_k) = 2 / (fs sum w^2) <|DFT(w (x - trend))|^2>,   Hann window, half overlap, each segment freed of its
//   straight line.
// Confidence: S/S_true is chi^2_nu / nu; with half overlap of Hann windows neighbouring segments correlate by
// 1/6, so K segments count as K_eff = K / (1 + 2 (1 - 1/K) / 36), nu = 2 K_eff (Welch, eq. 11; D. B. Percival,
// A. T. Walden, Spectral Analysis for Physical Applications, 1993, sec. 6.17). A band holds about
// width / (1.5 df) independent values (equivalent noise bandwidth of the Hann window), which assumes a density
// that is even within the band. Neglects: leakage of the window beyond its main lobe (-31 dB).
// Test: spectrum_test.

#include <cstddef>
#include <vector>

namespace filum {

struct WelchOptions {
  double segment = 4.0;     // [s], length of a segment: the resolution is 1.44 / segment
  double confidence = 0.95; // of all intervals
};

struct Spectrum {
  double df = 0.0;                // [Hz], of a bin
  std::vector<double> density;    // [unit^2/Hz], one-sided, from 0 Hz
  double segments = 0.0;          // that were averaged
  double degrees = 0.0;           // of freedom of one value, nu
  double frequency(std::size_t bin) const { return static_cast<double>(bin) * df; }
  /// [Hz], width at half height of a pure tone.
  double resolution() const { return 1.44 * df; }
};

/// Spectrum of evenly sampled stretches without gaps [unit], sampled at fs [Hz]. No segment spans two stretches;
/// segments == 0 when none is long enough.
Spectrum welch(const std::vector<std::vector<double>>& stretches, double fs, const WelchOptions& options = {});
/// Adds the densities of spectra of the same size (the axes of a vector); the degrees of freedom stay those of one,
/// which is the cautious side.
Spectrum sum_of(const std::vector<Spectrum>& spectra);

struct Interval {
  double low = 0.0, value = 0.0, high = 0.0;
};

/// Power between two frequencies [Hz] with its confidence interval. [unit^2]
Interval band_power(const Spectrum& spectrum, double from, double to, double confidence = 0.95);

struct SpectralPeak {
  double frequency = 0.0;   // [Hz], parabola through the logarithm of the highest bin and its neighbours
  double density = 0.0;     // [unit^2/Hz]
  double half_width = 0.0;  // [Hz], full width at half the density; NaN where it does not fall so far in the band
  bool narrow = false;      // the width is that of the window: the true one may be less
};

/// Highest value between two frequencies [Hz].
SpectralPeak peak_between(const Spectrum& spectrum, double from, double to);

}  // namespace filum
