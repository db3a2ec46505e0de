#include "analysis/spectrum.h"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <complex>
#include <numbers>
#include <unsupported/Eigen/FFT>

#include "base/numbers.h"

namespace filum {
namespace {

std::vector<double> hann(std::size_t n) {
  std::vector<double> window(n);
  for (std::size_t k = 0; k < n; ++k)
    window[k] = 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(n));
  return window;
}

/// x[from ... from+n) without its straight line (least squares), times the window.
std::vector<double> prepared(const std::vector<double>& x, std::size_t from, const std::vector<double>& window) {
  const std::size_t n = window.size();
  const double middle = 0.5 * static_cast<double>(n - 1);
  double mean = 0.0, slope = 0.0, square = 0.0;
  for (std::size_t k = 0; k < n; ++k) {
    const double t = static_cast<double>(k) - middle;
    mean += x[from + k];
    slope += t * x[from + k];
    square += t * t;
  }
  mean /= static_cast<double>(n);
  slope /= square;
  std::vector<double> y(n);
  for (std::size_t k = 0; k < n; ++k)
    y[k] = window[k] * (x[from + k] - mean - slope * (static_cast<double>(k) - middle));
  return y;
}

double quantile(double degrees, double p) {
  return boost::math::quantile(boost::math::chi_squared(degrees), p);
}

}  // namespace

Spectrum welch(const std::vector<std::vector<double>>& stretches, double fs, const WelchOptions& options) {
  const auto n = static_cast<std::size_t>(std::lround(options.segment * fs));
  Spectrum s;
  if (n < 16) return s;
  const std::vector<double> window = hann(n);
  double weight = 0.0;
  for (double w : window) weight += w * w;
  s.df = fs / static_cast<double>(n);
  s.density.assign(n / 2 + 1, 0.0);
  Eigen::FFT<double> fft;
  std::vector<std::complex<double>> transform;
  for (const std::vector<double>& x : stretches) {
    for (std::size_t from = 0; from + n <= x.size(); from += n / 2, s.segments += 1.0) {
      fft.fwd(transform, prepared(x, from, window));
      for (std::size_t k = 0; k < s.density.size(); ++k) s.density[k] += std::norm(transform[k]);
    }
  }
  if (s.segments == 0.0) return s;
  for (std::size_t k = 0; k < s.density.size(); ++k) {
    const bool single = k == 0 || 2 * k == n;  // 0 Hz and Nyquist stand once in a two-sided spectrum
    s.density[k] *= (single ? 1.0 : 2.0) / (fs * weight * s.segments);
  }
  s.degrees = 2.0 * s.segments / (1.0 + 2.0 * (1.0 - 1.0 / s.segments) / 36.0);
  return s;
}

Spectrum sum_of(const std::vector<Spectrum>& spectra) {
  Spectrum sum = spectra.front();
  for (std::size_t i = 1; i < spectra.size(); ++i)
    for (std::size_t k = 0; k < sum.density.size(); ++k) sum.density[k] += spectra[i].density[k];
  return sum;
}

Interval band_power(const Spectrum& s, double from, double to, double confidence) {
  Interval band;
  for (std::size_t k = 0; k < s.density.size(); ++k) {
    // Each bin stands for df about its frequency; those at the edges count by their share.
    const double low = std::max(from, s.frequency(k) - 0.5 * s.df), high = std::min(to, s.frequency(k) + 0.5 * s.df);
    if (high > low) band.value += s.density[k] * (high - low);
  }
  const double values = std::max(1.0, (to - from) / (1.5 * s.df));
  const double nu = s.degrees * values, tail = 0.5 * (1.0 - confidence);
  if (s.segments == 0.0) return band;
  band.low = band.value * nu / quantile(nu, 1.0 - tail);
  band.high = band.value * nu / quantile(nu, tail);
  return band;
}

SpectralPeak peak_between(const Spectrum& s, double from, double to) {
  SpectralPeak peak{kNaN, kNaN, kNaN, false};
  std::size_t best = 0;
  for (std::size_t k = 1; k + 1 < s.density.size(); ++k)
    if (s.frequency(k) >= from && s.frequency(k) <= to && (best == 0 || s.density[k] > s.density[best])) best = k;
  if (best == 0 || !(s.density[best] > 0.0)) return peak;
  // The main lobe of a Hann window is nearly a parabola in the logarithm.
  const auto level = [&](std::size_t k) { return std::log(std::max(s.density[k], 1e-30 * s.density[best])); };
  const double a = level(best - 1), b = level(best), c = level(best + 1);
  const double curve = a - 2.0 * b + c;
  const double shift = curve < 0.0 ? std::clamp(0.5 * (a - c) / curve, -0.5, 0.5) : 0.0;
  peak.frequency = s.frequency(best) + shift * s.df;
  peak.density = std::exp(b - 0.25 * (a - c) * shift);
  const double half = std::log(0.5 * peak.density);
  const auto crossing = [&](int step) {
    for (std::size_t k = best; k > 0 && k + 1 < s.density.size(); k = k + static_cast<std::size_t>(step)) {
      const std::size_t next = k + static_cast<std::size_t>(step);
      if (s.density[next] > 0.5 * peak.density) continue;
      const double share = (level(k) - half) / (level(k) - level(next));
      return s.frequency(k) + step * std::max(0.0, share) * s.df;
    }
    return kNaN;
  };
  peak.half_width = crossing(1) - crossing(-1);
  peak.narrow = peak.half_width < 1.5 * s.resolution();
  return peak;
}

}  // namespace filum
